// Mends for mistakes: what a click can change so that a mistake is gone.
//
// Owns the table of them. Which mistake it is, is seen from the drawing itself, for its message is for people and in their
// language. Knows no draft; what is to be changed is told.

import type {
  Change,
  DrawnBlock,
  DrawnLink,
  DrawnSheet,
  Finding,
  NameFacts,
  PaletteBlock,
} from '../engine/facts';
import { guardOfNext, guardsOf } from '../draw/guards';
import { roomIn } from '../draw/near';
import { given, nameAt, nearNames, replaced } from './names';
import { beside, leading, leaving, leavesMost, leavesLeast, mayLeadTo, nearest } from './around';
import { words } from './words';

/** One change after the other; a later one may need the ids of what the one before has made. */
export type Step = Change | ((made: readonly string[]) => Change);

export interface Fix {
  /** What it does. */
  title: string;
  steps: Step[];
}

/** What is known of the drawing. */
export interface Drawn {
  sheet: DrawnSheet;
  names: readonly NameFacts[];
  /** Names of what this diagram is given by its callers. */
  parameters: readonly string[];
  /** Names and ids of subprograms. */
  subprograms: readonly { id: string; name: string }[];
  facts: (kind: string) => PaletteBlock | undefined;
}

/** A mistake in a block of the sheet. */
interface Case extends Drawn {
  finding: Finding;
  block: DrawnBlock;
}

interface Row {
  /** Whether it may be this mistake. */
  when: (at: Case) => boolean;
  mend: (at: Case) => Fix[];
}

/** Of one kind of mend so many are offered. */
const OFFERED = 3;

/** It says nothing of a property. */
const ofBlock = ({ finding }: Case): boolean => !finding.property;

const FIXES: Row[] = [
  // Nothing leaves it, or too little.
  { when: (at) => ofBlock(at) && isDeadEnd(at), mend: (at) => [...led(at), ...ended(at)] },
  // Nothing leads to it.
  { when: (at) => ofBlock(at) && isAlone(at), mend: (at) => [...reached(at), removed(at)] },
  // Links of a block that decides are marked wrongly.
  { when: (at) => ofBlock(at) && isMarkedWrongly(at), mend: marked },
  // More leaves it than can.
  { when: (at) => ofBlock(at) && leaving(at.sheet, at.block).length > leavesMost(at.block), mend: loosened },
  // A link of it hangs loose.
  { when: (at) => ofBlock(at) && looseOf(at).length > 0, mend: unhung },
  // A call of nothing.
  { when: ({ block }) => block.kind === 'Subprogram' && !block.calls, mend: called },
  // A name that nobody knows.
  { when: (at) => unknownOf(at) !== undefined, mend: renamed },
  // A word that a choice does not have, or nothing where something has to be.
  { when: (at) => lackingOf(at).length > 0, mend: filled },
];

/** What can be done about a finding; nothing, if it is not of this sheet or no mend is known. */
export function fixesOf(finding: Finding, drawn: Drawn): Fix[] {
  const { sheet } = drawn;
  const link = sheet.links.find(({ id }) => id === finding.object);
  const id = link ? link.from : finding.object;
  const block = sheet.blocks.find((one) => one.id === id);
  if (!block) return finding.object === sheet.id ? begun(drawn) : [];
  const at: Case = { ...drawn, finding, block };
  const fixes = FIXES.filter(({ when }) => when(at)).flatMap(({ mend }) => mend(at));
  const titles = new Set<string>();
  return fixes.filter(({ title }) => !titles.has(title) && titles.add(title));
}

function isDeadEnd({ sheet, block }: Case): boolean {
  return leaving(sheet, block).length < leavesLeast(block);
}

function isAlone({ sheet, block }: Case): boolean {
  return mayLeadTo(block) && leading(sheet, block).length === 0;
}

/** The guard of the next link of a block. */
function guardOf({ sheet, block }: Pick<Case, 'sheet' | 'block'>): string {
  return guardOfNext(block.kind, leaving(sheet, block));
}

/** To the nearest block: best to one to which nothing leads. */
function led({ sheet, block }: Case): Fix[] {
  const before = new Set(
    [...leading(sheet, block), ...leaving(sheet, block)].flatMap(({ from, to }) => [from, to]),
  );
  const others = sheet.blocks.filter((one) => one.id !== block.id && mayLeadTo(one) && !before.has(one.id));
  const alone = others.filter((one) => leading(sheet, one).length === 0);
  const to = nearest(block, alone.length > 0 ? alone : others);
  if (!to) return [];
  const change: Change = { do: 'connect', from: block.id, to: to.id, guard: guardOf({ sheet, block }) };
  return [{ title: words.connectTo(nameOf(to)), steps: [change] }];
}

/** To an end of its own. */
function ended({ sheet, block, facts }: Case): Fix[] {
  const end = facts('FinalNode');
  if (!end) return [];
  const made = { kind: end.kind, at: beside(sheet, block), name: end.title };
  const add: Change = { do: 'add', diagram: sheet.id, blocks: [made], links: [] };
  const guard = guardOf({ sheet, block });
  const connect: Step = ([to = '']) => ({ do: 'connect', from: block.id, to, guard });
  return [{ title: words.addEnd, steps: [add, connect] }];
}

/** From the nearest block that has room for a link: best from one that leads nowhere. */
function reached({ sheet, block }: Case): Fix[] {
  const open = sheet.blocks.filter(
    (one) => one.id !== block.id && leaving(sheet, one).length < leavesMost(one),
  );
  const ends = open.filter((one) => leaving(sheet, one).length < leavesLeast(one));
  const from = nearest(block, ends.length > 0 ? ends : open);
  if (!from) return [];
  const change: Change = {
    do: 'connect',
    from: from.id,
    to: block.id,
    guard: guardOf({ sheet, block: from }),
  };
  return [{ title: words.connectFrom(nameOf(from)), steps: [change] }];
}

function removed({ block }: Case): Fix {
  return { title: words.remove(nameOf(block)), steps: [{ do: 'remove', ids: [block.id] }] };
}

const guardsAt = (links: readonly DrawnLink[]): string[] =>
  links.map(({ guard }) => guard.trim().toLowerCase());

function isMarkedWrongly({ sheet, block }: Case): boolean {
  const links = leaving(sheet, block);
  const known = guardsOf(block.kind);
  if (!known || links.length === 0 || links.length > 2) return false;
  const guards = guardsAt(links);
  const used = guards.filter((guard) => known.includes(guard));
  const isTwice = new Set(guards).size < guards.length;
  return used.length === 0 || isTwice || (known.length === 1 && used.length > 1);
}

/** Each link as the first one of its kind, the other one as what is left. */
function marked({ sheet, block }: Case): Fix[] {
  const [first = '', other = ''] = guardsOf(block.kind) ?? [];
  const links = leaving(sheet, block);
  return links.map((link) => {
    const wanted = links.map((one) => ({ id: one.id, has: one.guard, value: one === link ? first : other }));
    const steps = wanted
      .filter(({ has, value }) => has !== value)
      .map(({ id, value }): Change => ({ do: 'set', id, property: 'Guard', value }));
    return { title: words.mark(endOf(sheet, link), first), steps };
  });
}

function loosened({ sheet, block }: Case): Fix[] {
  return leaving(sheet, block)
    .slice(0, OFFERED)
    .map((link) => ({
      title: words.unlink(endOf(sheet, link)),
      steps: [{ do: 'remove', ids: [link.id] }],
    }));
}

function looseOf({ sheet, block }: Case): DrawnLink[] {
  return sheet.links.filter(
    ({ from, to }) => (from === block.id && to === null) || (to === block.id && from === null),
  );
}

function unhung(at: Case): Fix[] {
  const ids = looseOf(at).map(({ id }) => id);
  return [{ title: words.removeLoose, steps: [{ do: 'remove', ids }] }];
}

function called({ block, subprograms }: Case): Fix[] {
  return subprograms.slice(0, OFFERED).map(({ id, name }) => ({
    title: words.call(name),
    steps: [{ do: 'call', id: block.id, diagram: id }],
  }));
}

/** A property or an argument, as it is written. */
interface Text {
  value: string;
  set: (value: string) => Change;
}

/** The text of which a finding tells. */
function textOf({ block, finding, facts }: Case): Text | undefined {
  const { property } = finding;
  if (!property) return undefined;
  const known = facts(block.kind)?.properties.find(
    ({ name, found }) => name === property || found === property,
  );
  const name = known?.name ?? property;
  const value = block.properties[name] ?? known?.default;
  if (value !== undefined)
    return { value, set: (text) => ({ do: 'set', id: block.id, property: name, value: text }) };
  const argument = block.arguments.find((one) => one.name === property);
  if (!argument) return undefined;
  return {
    value: argument.value,
    set: (text) => ({ do: 'argument', id: block.id, name: argument.name, value: text }),
  };
}

/** The name at the place of a finding, if nobody knows it. */
function unknownOf(
  at: Case,
): (Text & { name: string; isCall: boolean; line: number; column: number }) | undefined {
  const text = textOf(at);
  const { line, column } = at.finding;
  if (!text || line === null || column === null) return undefined;
  const found = nameAt(text.value, line, column);
  if (!found || isKnown(at, found.name)) return undefined;
  return { ...text, ...found, line, column };
}

/** Every robot has it, it is a parameter, or this sheet gives it a value. */
function isKnown({ names, parameters, sheet, facts }: Case, name: string): boolean {
  const known = names.find((one) => one.name === name);
  if (known && known.is !== 'variable') return true;
  return parameters.includes(name) || given(sheet, facts).has(name);
}

/** Another name that was meant; or a value before the program begins. */
function renamed(at: Case): Fix[] {
  const unknown = unknownOf(at);
  if (!unknown) return [];
  const { name, value, line, column, set, isCall } = unknown;
  const others = at.names.filter((one) => one.name !== name);
  const near = nearNames(name, others).map((other) => ({
    title: words.replace(name, other),
    steps: [set(replaced(value, line, column, name, other))],
  }));
  return [...near, ...(isCall ? [] : valued(at, name))];
}

/** A value for a name, right after the beginning of its diagram. */
function valued({ sheet, facts }: Case, variable: string): Fix[] {
  const begin = sheet.blocks.find(({ kind }) => kind === 'InitialNode');
  const first = begin && leaving(sheet, begin)[0];
  const room = first && roomIn(sheet, first);
  const init = facts('VariableInit');
  if (!first || !room || !init) return [];
  const block = { kind: init.kind, at: room, name: init.title, properties: { variable, value: '0' } };
  return [{ title: words.giveValue(variable), steps: [{ do: 'insert', link: first.id, block }] }];
}

/** Properties that have no value that they may have, with what they have at first. */
function lackingOf({ block, finding, facts }: Case): { name: string; title: string; byDefault: string }[] {
  return (facts(block.kind)?.properties ?? [])
    .filter(({ name, found }) => !finding.property || finding.property === name || finding.property === found)
    .filter(({ name, choices, default: byDefault }) => {
      const value = block.properties[name];
      if (value === undefined || byDefault.trim() === '') return false;
      return choices ? !choices.includes(value) : value.trim() === '';
    })
    .map(({ name, title, default: byDefault }) => ({ name, title, byDefault }));
}

function filled(at: Case): Fix[] {
  return lackingOf(at).map(({ name, title, byDefault }) => ({
    title: words.put(byDefault, title),
    steps: [{ do: 'set', id: at.block.id, property: name, value: byDefault }],
  }));
}

/** A beginning for a diagram that has none. */
function begun({ sheet, facts }: Drawn): Fix[] {
  const begin = facts('InitialNode');
  const first = sheet.blocks
    .filter((one) => mayLeadTo(one))
    .toSorted(
      (one, other) => leading(sheet, one).length - leading(sheet, other).length || one.at[0] - other.at[0],
    )[0];
  if (!begin || sheet.blocks.some(({ kind }) => kind === 'InitialNode')) return [];
  const at: [number, number] = first ? [first.at[0] - 120, first.at[1]] : [100, 100];
  const block = { kind: begin.kind, at, name: begin.title };
  const add: Change = { do: 'add', diagram: sheet.id, blocks: [block], links: [] };
  const connect: Step = ([from = '']) => ({ do: 'connect', from, to: first?.id ?? '', guard: '' });
  return [{ title: words.addBeginning, steps: first ? [add, connect] : [add] }];
}

function endOf(sheet: DrawnSheet, { to }: DrawnLink): string {
  const block = sheet.blocks.find(({ id }) => id === to);
  return block ? nameOf(block) : '';
}

/** As a person finds it on the sheet. */
function nameOf({ title, details }: DrawnBlock): string {
  const text = details ? `${title}: ${details}` : title;
  return text.length > 40 ? `${text.slice(0, 39)}\u2026` : text;
}
