// Lets a person choose a recording from this computer.
//
// The field for it is never in the page, where a label would have to be made for it: the button that opens it has one.

/** Calls back with the file, if one is chosen. */
export function choose(chosen: (file: File) => void): void {
  const field = document.createElement('input');
  field.type = 'file';
  field.accept = '.mcap';
  field.onchange = () => {
    const file = field.files?.[0];
    if (file) chosen(file);
  };
  field.click();
}
