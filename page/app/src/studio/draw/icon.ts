// The picture of a block, as the table of blocks has it: pieces of SVG, taken apart and put together again.
//
// Owns which elements and attributes a picture may have.

const TAGS = new Set(['path', 'circle', 'ellipse', 'rect', 'line', 'polyline', 'polygon', 'text', 'g']);
const ATTRIBUTES =
  /^(class|d|cx|cy|r|rx|ry|x|y|x1|x2|y1|y2|width|height|points|transform|fill|stroke|stroke-width|font-size|text-anchor)$/;

/** Colours of the groups, which are those of TRIK Studio's pictures here. */
export const COLOURS = {
  algorithms: '#3572b0',
  actions: '#2f9e5a',
  wait: '#a86d0f',
  drawing: '#8a4fb5',
  subprograms: '#5d6770',
  control: '#3572b0',
  streams: '#a86d0f',
  devices: '#2f9e5a',
  shell: '#2b8a8a',
} as const;

/** Puts a picture into an element of SVG for as long as that is there. */
export function drawn(icon: string): (element: SVGElement) => () => void {
  return (element) => {
    const text = `<svg xmlns="http://www.w3.org/2000/svg">${icon}</svg>`;
    const root = new DOMParser().parseFromString(text, 'image/svg+xml').documentElement;
    for (const one of [...root.querySelectorAll('*')]) {
      if (!TAGS.has(one.localName)) one.remove();
      for (const { name } of [...one.attributes]) if (!ATTRIBUTES.test(name)) one.removeAttribute(name);
    }
    const parts = [...root.children].map((one) => document.importNode(one, true));
    element.append(...parts);
    return () => {
      for (const one of parts) one.remove();
    };
  };
}
