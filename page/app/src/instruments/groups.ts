// The nodes of a tree by their folders, and those that a person looks for.
//
// Owns which node is in which group; knows paths alone.

export interface Group {
  /** The folder; empty for nodes at the top. */
  folder: string;
  paths: string[];
}

/** What is looked at to find a node. */
export interface Named {
  path: string;
  aliases: readonly string[];
}

/** Groups in order, the nodes at the top first. */
export function grouped(paths: readonly string[]): Group[] {
  const groups = new Map<string, string[]>();
  for (const path of paths) {
    const end = path.lastIndexOf('/');
    const folder = end < 0 ? '' : path.slice(0, end);
    const group = groups.get(folder);
    if (group) group.push(path);
    else groups.set(folder, [path]);
  }
  return [...groups].map(([folder, group]) => ({ folder, paths: group })).sort(byFolder);
}

function byFolder(one: Group, other: Group): number {
  return one.folder < other.folder ? -1 : 1;
}

/** Whether each word of a search is in a name of the node, in small or large letters. */
export function isFound(node: Named, search: string): boolean {
  const words = search.toLowerCase().split(/\s+/);
  const names = [node.path, ...node.aliases].join(' ').toLowerCase();
  return words.every((word) => names.includes(word));
}

/** The last part of a path. */
export function leaf(path: string): string {
  return path.slice(path.lastIndexOf('/') + 1);
}
