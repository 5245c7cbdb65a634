// What is dragged from the list of blocks to the sheet.

/** The type of what is dragged, so that the sheet takes nothing else. */
export const DRAGGED = 'application/x-trik-block';

export interface Dropped {
  kind: string;
  /** The name of a subprogram. */
  calls?: string;
}
