// A file for the person who looks at the page.

/** A name of a file of words from outside. */
export function fileName(words: string, ending: string): string {
  const plain = words.replace(/[^\p{L}\p{N}._-]+/gu, '-').replace(/^[-.]+|[-.]+$/g, '');
  return `${plain.slice(0, 80) || 'trik'}.${ending}`;
}

/** The browser keeps it where its owner wants it. */
export function save(name: string, content: Blob): void {
  const address = URL.createObjectURL(content);
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
