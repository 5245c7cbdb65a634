// The elements of rules as forms: the attributes of each, and what may stand in it.
//
// Owns that table. What it does not know - templates, and what has another form - is shown as text and stays.

import type { Tag } from './xml';

/** What an attribute takes, which decides what its field is and what it offers. */
export type RuleTakes =
  'ms' | 'number' | 'text' | 'truth' | 'choice' | 'event' | 'object' | 'region' | 'state' | 'variable';

export interface RuleAttribute {
  name: string;
  takes: RuleTakes;
  /** What counts where it is not written; undefined: it has to be. */
  default?: string;
  choices?: readonly string[];
}

/** What may stand in a place. */
export type RuleGroup =
  'top' | 'conditionOf' | 'triggerOf' | 'condition' | 'trigger' | 'value' | 'return' | 'replace';

/** A place for children: how many of a group. */
export interface Slot {
  group: RuleGroup;
  least: number;
  most: number;
}

export const RULE_TAGS = [
  'timelimit',
  'constraint',
  'event',
  'init',
  'condition',
  'conditions',
  'not',
  'true',
  'equals',
  'notEqual',
  'greater',
  'less',
  'notGreater',
  'notLess',
  'inside',
  'settedUp',
  'dropped',
  'timer',
  'using',
  'return',
  'trigger',
  'triggers',
  'fail',
  'success',
  'message',
  'log',
  'replace',
  'setter',
  'setUp',
  'drop',
  'setState',
  'bool',
  'int',
  'double',
  'string',
  'variableValue',
  'objectState',
  'typeOf',
  'sum',
  'difference',
  'mul',
  'min',
  'max',
  'distance',
  'minus',
  'abs',
  'boundingRect',
] as const;
export type RuleTag = (typeof RULE_TAGS)[number];

export interface RuleElement {
  tag: RuleTag;
  groups: readonly RuleGroup[];
  attributes: readonly RuleAttribute[];
  takes: readonly Slot[];
  /** Values may stand in as many attributes `_1`, `_2` instead of tags. */
  operands?: number;
  /** A new one. */
  made: string;
}

const attribute = (
  name: string,
  takes: RuleTakes,
  byDefault?: string,
  choices?: string[],
): RuleAttribute => ({
  name,
  takes,
  ...(byDefault === undefined ? {} : { default: byDefault }),
  ...(choices ? { choices } : {}),
});
const slot = (group: RuleGroup, least: number, most = least): Slot => ({ group, least, most });
const ID = attribute('id', 'text', '');
const TRUE = '<true/>';
const DONE = '<success/>';
const ZERO = '<int value="0"/>';

const row = (
  tag: RuleTag,
  groups: RuleGroup[],
  attributes: RuleAttribute[],
  takes: Slot[],
  made: string,
): RuleElement => ({ tag, groups, attributes, takes, made });

/** Values that are computed of others, and conditions that compare them. */
const of = (tag: RuleTag, group: RuleGroup, operands: number, made = ZERO.repeat(operands)): RuleElement => ({
  ...row(tag, [group], [], [slot('value', operands)], `<${tag}>${made}</${tag}>`),
  operands,
});

/** Values that stand there as they are. */
const constant = (tag: RuleTag, takes: RuleTakes, made: string): RuleElement =>
  row(tag, ['value'], [attribute('value', takes)], [], `<${tag} value="${made}"/>`);

const COMPARED = '<objectState object="robot1.x"/><int value="0"/>';
const CONDITION = [slot('condition', 1)];

export const RULES: readonly RuleElement[] = [
  row('timelimit', ['top'], [attribute('value', 'ms')], [], '<timelimit value="60000"/>'),
  row(
    'constraint',
    ['top'],
    [attribute('failMessage', 'text'), attribute('checkOnce', 'truth', 'false'), ID],
    CONDITION,
    `<constraint failMessage="-">\n    ${TRUE}\n</constraint>`,
  ),
  row(
    'event',
    ['top'],
    [ID, attribute('settedUpInitially', 'truth', 'false'), attribute('dropsOnFire', 'truth', 'true')],
    [slot('conditionOf', 1), slot('triggerOf', 1)],
    `<event id="%" settedUpInitially="true">\n    <condition>${TRUE}</condition>\n    <triggers>${DONE}</triggers>\n</event>`,
  ),
  row('init', ['top'], [], [slot('trigger', 1, Infinity)], '<init>\n    <message text="-"/>\n</init>'),
  row('condition', ['conditionOf', 'condition'], [], CONDITION, `<condition>${TRUE}</condition>`),
  row(
    'conditions',
    ['conditionOf', 'condition'],
    [attribute('glue', 'choice', undefined, ['and', 'or'])],
    [slot('condition', 1, Infinity)],
    `<conditions glue="and">\n    ${TRUE}\n    ${TRUE}\n</conditions>`,
  ),
  row(
    'inside',
    ['condition'],
    [
      attribute('objectId', 'object'),
      attribute('regionId', 'region'),
      attribute('objectPoint', 'choice', 'center', ['center', 'all', 'any']),
    ],
    [],
    '<inside objectId="robot1" regionId="%"/>',
  ),
  row('not', ['condition'], [], CONDITION, `<not>${TRUE}</not>`),
  of('equals', 'condition', 2, COMPARED),
  of('notEqual', 'condition', 2, COMPARED),
  of('greater', 'condition', 2, COMPARED),
  of('less', 'condition', 2, COMPARED),
  of('notGreater', 'condition', 2, COMPARED),
  of('notLess', 'condition', 2, COMPARED),
  row(
    'timer',
    ['condition'],
    [attribute('timeout', 'ms'), attribute('forceDropOnTimeout', 'truth', 'true')],
    [],
    '<timer timeout="1000"/>',
  ),
  row('settedUp', ['condition'], [attribute('id', 'event')], [], '<settedUp id="%"/>'),
  row('dropped', ['condition'], [attribute('id', 'event')], [], '<dropped id="%"/>'),
  row(
    'using',
    ['condition'],
    [],
    [slot('trigger', 1, Infinity), slot('return', 1)],
    `<using>\n    <setter name="x">${ZERO}</setter>\n    <return>${TRUE}</return>\n</using>`,
  ),
  row('return', ['return'], [], CONDITION, `<return>${TRUE}</return>`),
  row('true', ['condition'], [], [], TRUE),
  row('trigger', ['triggerOf', 'trigger'], [], [slot('trigger', 1)], `<trigger>${DONE}</trigger>`),
  row(
    'triggers',
    ['triggerOf', 'trigger'],
    [],
    [slot('trigger', 1, Infinity)],
    `<triggers>\n    ${DONE}\n</triggers>`,
  ),
  row('success', ['trigger'], [attribute('deferred', 'truth', 'false')], [], DONE),
  row('fail', ['trigger'], [attribute('message', 'text')], [], '<fail message="-"/>'),
  row(
    'message',
    ['trigger'],
    [attribute('text', 'text')],
    [slot('replace', 0, Infinity)],
    '<message text="-"/>',
  ),
  row('log', ['trigger'], [attribute('text', 'text')], [slot('replace', 0, Infinity)], '<log text="-"/>'),
  {
    ...row('setter', ['trigger'], [attribute('name', 'variable')], [slot('value', 1)], ''),
    operands: 1,
    made: `<setter name="total_score">${ZERO}</setter>`,
  },
  row('setUp', ['trigger'], [attribute('id', 'event')], [], '<setUp id="%"/>'),
  row('drop', ['trigger'], [attribute('id', 'event')], [], '<drop id="%"/>'),
  {
    ...row(
      'setState',
      ['trigger'],
      [attribute('object', 'object'), attribute('property', 'text')],
      [slot('value', 1)],
      '',
    ),
    operands: 1,
    made: '<setState object="robot1.display" property="background"><string value="green"/></setState>',
  },
  {
    ...row('replace', ['replace'], [attribute('var', 'text')], [slot('value', 1)], ''),
    operands: 1,
    made: `<replace var="x">${ZERO}</replace>`,
  },
  row('objectState', ['value'], [attribute('object', 'state')], [], '<objectState object="robot1.x"/>'),
  row('variableValue', ['value'], [attribute('name', 'variable')], [], '<variableValue name="total_score"/>'),
  constant('int', 'number', '0'),
  constant('double', 'number', '0.5'),
  constant('bool', 'truth', 'true'),
  constant('string', 'text', ''),
  of('sum', 'value', 2),
  of('difference', 'value', 2),
  of('mul', 'value', 2),
  of('min', 'value', 2),
  of('max', 'value', 2),
  of('minus', 'value', 1),
  of('abs', 'value', 1),
  of('distance', 'value', 2, '<objectState object="robot1.x"/><objectState object="robot1.y"/>'),
  of('boundingRect', 'value', 1, '<objectState object="robot1.display.labels"/>'),
  row('typeOf', ['value'], [attribute('objectId', 'object')], [], '<typeOf objectId="robot1"/>'),
];

/** Names of tags may be in any case, and some have others. */
const BY_TAG = new Map(RULES.map((element) => [element.tag.toLowerCase(), element]));
BY_TAG.set('initialization', BY_TAG.get('init') as RuleElement);

/** The row of a tag; undefined if its forms have none. */
export function elementOf(tag: Tag): RuleElement | undefined {
  return BY_TAG.get(tag.name.toLowerCase());
}

export function elementsOf(group: RuleGroup): readonly RuleElement[] {
  return RULES.filter(({ groups }) => groups.includes(group));
}

/** Whether values stand in attributes. */
export function hasOperands(tag: Tag): boolean {
  return tag.attributes.some(({ name }) => name.startsWith('_'));
}

/** The place of an element that a child is in, and the others of that place. */
export function placed(element: RuleElement, tag: Tag): { slot: Slot; children: Tag[] }[] {
  const free = new Set(tag.children);
  return element.takes.map((one, at) => {
    const isLast = at === element.takes.length - 1;
    const children = [...free].filter((inner) => {
      const known = elementOf(inner);
      // What is not known stands in the last place, where it is shown as text.
      return known ? known.groups.includes(one.group) || isLast : isLast;
    });
    for (const inner of children) free.delete(inner);
    return { slot: one, children };
  });
}

/** A new element; `named` is what it names first: a region, an event. */
export function madeOf(element: RuleElement, named: string): string {
  return element.made.replace('%', named);
}

/** What a tag becomes when a person chooses another element for its place: one that can take it along does. */
export function instead(element: RuleElement, tag: Tag, source: string, named: string): string {
  const groups = elementOf(tag)?.groups ?? [];
  const takes = element.takes.length === 1 ? element.takes[0] : undefined;
  const isSame = groups.some((group) => element.groups.includes(group));
  if (
    !takes ||
    takes.group === 'value' ||
    takes.group === 'replace' ||
    !isSame ||
    !groups.includes(takes.group)
  )
    return madeOf(element, named);
  const attributes = element.tag === 'conditions' ? ' glue="and"' : '';
  return `<${element.tag}${attributes}>${source}</${element.tag}>`;
}

/** Names that rules can use, of one kind each. */
export interface RuleNames {
  events: string[];
  regions: string[];
  objects: string[];
  states: string[];
  variables: string[];
}

const ROBOT = [
  'x',
  'y',
  'rotation',
  'isRiding',
  'M3.power',
  'M4.power',
  'A1.value',
  'D1.value',
  'E3.value',
  'E4.value',
];
const DEVICES = [
  'display.background',
  'display.smiles',
  'display.labels.size',
  'shell.lastPhrase',
  'led.color',
];

/** The names of a world, and of rules in it. */
export function namesOf(
  things: readonly { id: string; kind: { tag: string } }[],
  constraints: Tag | undefined,
): RuleNames {
  const ids = (isWanted: (tag: string) => boolean) => [
    ...new Set(things.filter(({ id, kind }) => id && isWanted(kind.tag)).map(({ id }) => id)),
  ];
  const objects = ids(
    (tag) => !['region', 'robot', 'comment', 'image', 'background', 'segment'].includes(tag),
  );
  const variables = new Set(['total_score']);
  const events = new Set<string>();
  // No recursion: a text of a stranger may be deep.
  const open = [...(constraints?.children ?? [])];
  for (let tag = open.pop(); tag; tag = open.pop()) {
    const name = tag.name.toLowerCase();
    const id = tag.attributes.find((one) => one.name === (name === 'setter' ? 'name' : 'id'))?.value;
    if (id && name === 'setter') variables.add(id);
    if (id && name === 'event') events.add(id);
    open.push(...tag.children);
  }
  return {
    events: [...events].toSorted(),
    regions: ids((tag) => tag === 'region'),
    objects: ['robot1', ...objects],
    states: [
      ...[...ROBOT, ...DEVICES].map((name) => `robot1.${name}`),
      ...objects.flatMap((id) => [`${id}.x`, `${id}.y`]),
    ],
    variables: [...variables],
  };
}

/** Rules that many tasks have, with the names that are in them. */
export const RECIPES = ['goal', 'forbidden', 'leaves', 'start', 'points', 'message'] as const;
export type Recipe = (typeof RECIPES)[number];

/** A whole rule; `region` and `id` are as they stand within quotes. */
export function recipe(name: Recipe, region: string, id: string, text: string): string {
  const inside = `<inside objectId="robot1" regionId="${region}"/>`;
  const event = (condition: string, trigger: string) =>
    `<event id="${id}" settedUpInitially="true">\n    <condition>${condition}</condition>\n    <triggers>${trigger}</triggers>\n</event>`;
  switch (name) {
    case 'goal':
      return event(inside, DONE);
    case 'forbidden':
      return event(inside, `<fail message="${text}"/>`);
    case 'leaves':
      return `<constraint failMessage="${text}">\n    ${inside}\n</constraint>`;
    case 'start':
      return `<constraint failMessage="${text}" checkOnce="true">\n    ${inside}\n</constraint>`;
    case 'points': {
      const sum = '<sum><variableValue name="total_score"/><int value="10"/></sum>';
      return event(inside, `<setter name="total_score">${sum}</setter>`);
    }
    case 'message':
      return event(inside, `<message text="${text}"/>`);
  }
}

/** Rules of a world that has none: at least a limit of time. */
export const NEW_RULES = `<constraints>\n    <timelimit value="60000"/>\n</constraints>`;
