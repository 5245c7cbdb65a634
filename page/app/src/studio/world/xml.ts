// A text in XML as tags with their places in it, and changes of it that leave every other letter as it is.
//
// Owns how a text is looked through and how a change is spliced into it. Knows no tag of a world.

import { XML_DEPTH_MAX, XML_LETTERS_MAX, XML_TAGS_MAX } from '../../limits';

/** An attribute; places are letters of the text. */
export interface Attribute {
  name: string;
  value: string;
  /** From its name to the quote behind its value. */
  from: number;
  to: number;
  /** Within the quotes. */
  valueFrom: number;
  quote: string;
}

export interface Tag {
  name: string;
  attributes: Attribute[];
  children: Tag[];
  outside: Tag | undefined;
  from: number;
  to: number;
  /** Behind the `>` of the tag that opens it. */
  openTo: number;
  /** The `<` of the tag that closes it; that of the text behind it if it closes itself. */
  closeFrom: number;
}

export interface XmlDocument {
  text: string;
  root: Tag;
}

/** Why a text is no document, and at which letter. */
export interface XmlFault {
  fault: 'noRoot' | 'notClosed' | 'wrongEnd' | 'badTag' | 'tooDeep' | 'tooMany' | 'tooLong';
  at: number;
}

/** A stretch of the text that becomes another one. */
export interface Splice {
  from: number;
  to: number;
  text: string;
}

const NAME = /[^\s=<>/"'&!?]+/y;
const SPACE = /\s*/y;
/** What is between two tags and is no tag: how it begins and ends. */
const OTHERS = [
  ['<!--', '-->'],
  ['<![CDATA[', ']]>'],
  ['<?', '?>'],
] as const;

/** Looks through a text, once, whatever it is. */
class Scanner {
  at = 0;
  count = 0;

  constructor(readonly text: string) {}

  match(pattern: RegExp): string {
    pattern.lastIndex = this.at;
    const found = pattern.exec(this.text)?.[0] ?? '';
    this.at += found.length;
    return found;
  }

  /** Goes behind what is no tag; whether it was that. */
  skip(): boolean | undefined {
    for (const [begin, end] of OTHERS) {
      if (!this.text.startsWith(begin, this.at)) continue;
      const found = this.text.indexOf(end, this.at + begin.length);
      if (found < 0) return undefined;
      this.at = found + end.length;
      return true;
    }
    if (!this.text.startsWith('<!', this.at)) return false;
    // A type of documents, perhaps with declarations in brackets.
    const close = this.text.indexOf('>', this.at);
    const end = this.text.slice(this.at, close).includes('[') ? /\]\s*>/g : />/g;
    end.lastIndex = this.at;
    const found = end.exec(this.text);
    if (!found) return undefined;
    this.at = end.lastIndex;
    return true;
  }

  /** A tag that opens, from its `<` on; undefined: it is none. */
  open(outside: Tag | undefined): { tag: Tag; isWhole: boolean } | undefined {
    const from = this.at;
    this.at += 1;
    const name = this.match(NAME);
    if (!name) return undefined;
    const attributes: Attribute[] = [];
    const names = new Set<string>();
    for (;;) {
      this.match(SPACE);
      const isWhole = this.text.startsWith('/>', this.at);
      if (isWhole || this.text[this.at] === '>') {
        this.at += isWhole ? 2 : 1;
        const tag = { name, attributes, children: [], outside, from, to: this.at, openTo: this.at };
        return { tag: { ...tag, closeFrom: this.at }, isWhole };
      }
      const attribute = this.attribute();
      // No tag has an attribute twice.
      if (!attribute || names.has(attribute.name)) return undefined;
      names.add(attribute.name);
      attributes.push(attribute);
    }
  }

  attribute(): Attribute | undefined {
    const from = this.at;
    const name = this.match(NAME);
    this.match(SPACE);
    if (!name || this.text[this.at] !== '=') return undefined;
    this.at += 1;
    this.match(SPACE);
    const quote = this.text[this.at] ?? '';
    if (quote !== '"' && quote !== "'") return undefined;
    const valueFrom = this.at + 1;
    const end = this.text.indexOf(quote, valueFrom);
    if (end < 0) return undefined;
    this.at = end + 1;
    return { name, value: decoded(this.text.slice(valueFrom, end)), from, to: this.at, valueFrom, quote };
  }
}

/** The tags of a text. It takes time as the text is long, and never fails otherwise than by a fault. */
export function read(text: string): XmlDocument | XmlFault {
  if (text.length > XML_LETTERS_MAX) return { fault: 'tooLong', at: XML_LETTERS_MAX };
  const scanner = new Scanner(text);
  let root: Tag | undefined;
  let inside: Tag | undefined;
  let depth = 0;
  for (;;) {
    const at = text.indexOf('<', scanner.at);
    if (at < 0) break;
    scanner.at = at;
    const skipped = scanner.skip();
    if (skipped === undefined) return { fault: 'notClosed', at };
    if (skipped) continue;
    if (text[at + 1] === '/') {
      scanner.at += 2;
      const name = scanner.match(NAME);
      scanner.match(SPACE);
      if (!inside || name !== inside.name || text[scanner.at] !== '>') return { fault: 'wrongEnd', at };
      scanner.at += 1;
      inside.closeFrom = at;
      inside.to = scanner.at;
      inside = inside.outside;
      depth -= 1;
      continue;
    }
    const opened = scanner.open(inside);
    if (!opened) return { fault: 'badTag', at };
    scanner.count += 1;
    if (scanner.count > XML_TAGS_MAX) return { fault: 'tooMany', at };
    if (inside) inside.children.push(opened.tag);
    else if (root) return { fault: 'noRoot', at };
    else root = opened.tag;
    if (opened.isWhole) continue;
    inside = opened.tag;
    depth += 1;
    if (depth > XML_DEPTH_MAX) return { fault: 'tooDeep', at };
  }
  if (inside) return { fault: 'notClosed', at: inside.from };
  return root ? { text, root } : { fault: 'noRoot', at: 0 };
}

const ENTITIES: Record<string, string> = { lt: '<', gt: '>', amp: '&', quot: '"', apos: "'" };

function decoded(text: string): string {
  if (!/[&\n\r\t]/.test(text)) return text;
  return text
    .replace(/\r\n|[\n\r\t]/g, ' ')
    .replace(/&(#x[0-9a-f]{1,6}|#\d{1,7}|lt|gt|amp|quot|apos);/gi, (whole, name: string) => {
      if (!name.startsWith('#')) return ENTITIES[name] ?? whole;
      const code = name[1] === 'x' || name[1] === 'X' ? parseInt(name.slice(2), 16) : Number(name.slice(1));
      return code <= 0x10ffff ? String.fromCodePoint(code) : whole;
    });
}

/** A value as it stands within quotes. What no document may have goes. */
export function encoded(value: string, quote = '"'): string {
  return value
    .replace(/[^\t\n\r\x20-\ud7ff\ue000-\ufffd\u{10000}-\u{10ffff}]/gu, '')
    .replaceAll('&', '&amp;')
    .replaceAll('<', '&lt;')
    .replaceAll('\r\n', '\n')
    .replace(/[\n\r]/g, '&#10;')
    .replaceAll('\t', '&#9;')
    .replaceAll(quote, quote === '"' ? '&quot;' : '&apos;');
}

/** What an attribute says; undefined if it is not there. */
export function value(tag: Tag, name: string): string | undefined {
  return tag.attributes.find((one) => one.name === name)?.value;
}

export function child(tag: Tag, name: string): Tag | undefined {
  return tag.children.find((one) => one.name === name);
}

/** The text after changes, which may not overlap. Of two at one place the first one stands first. */
export function spliced(text: string, splices: readonly Splice[]): string {
  let done = '';
  let at = 0;
  for (const splice of splices.toSorted((one, other) => one.from - other.from || one.to - other.to)) {
    if (splice.from < at) continue;
    done += text.slice(at, splice.from) + splice.text;
    at = splice.to;
  }
  return done + text.slice(at);
}

/** Gives attributes other values; undefined takes one away. What a value says already stays as it is written. */
export function set(tag: Tag, changes: Readonly<Record<string, string | undefined>>): Splice[] {
  const splices: Splice[] = [];
  let end = tag.from + 1 + tag.name.length;
  for (const { to } of tag.attributes) end = Math.max(end, to);
  for (const [name, next] of Object.entries(changes)) {
    const there = tag.attributes.find((one) => one.name === name);
    if (there?.value === next) continue;
    if (there && next === undefined) {
      // With the space before it.
      const before = tag.attributes.filter(({ to }) => to <= there.from).at(-1);
      const from = before?.to ?? tag.from + 1 + tag.name.length;
      splices.push({ from, to: there.to, text: '' });
    } else if (there && next !== undefined) {
      const { valueFrom, to, quote } = there;
      splices.push({ from: valueFrom, to: to - 1, text: encoded(next, quote) });
    } else if (next !== undefined) {
      splices.push({ from: end, to: end, text: ` ${name}="${encoded(next)}"` });
    }
  }
  return splices;
}

/** The space before a tag that stands alone in its line, with the end of the line before it; empty if it does not. */
function indent(text: string, tag: Tag): string {
  return /\r?\n[ \t]*$/.exec(text.slice(Math.max(0, tag.from - 200), tag.from))?.[0] ?? '';
}

/** What stands before a child of a tag: as its others have it, or a step further in than the tag itself. */
function indentIn({ text }: XmlDocument, tag: Tag): string {
  const last = tag.children.at(-1);
  if (last) return indent(text, last);
  const own = indent(text, tag);
  const outer = tag.outside ? indent(text, tag.outside) : '';
  const step = own.length > outer.length ? own.slice(outer.length) : '    ';
  return own || !tag.outside ? `${own || '\n'}${step}` : '';
}

/** Puts a text with one tag into a tag: before the child of this number, or behind all. Its further lines are moved in. */
export function insert(document: XmlDocument, tag: Tag, xml: string, at = Infinity): Splice[] {
  const space = indentIn(document, tag);
  const inner = space ? xml.replaceAll('\n', space) : xml;
  const next = tag.children[at];
  if (next) return [{ from: next.from, to: next.from, text: inner + space }];
  const last = tag.children.at(-1);
  if (last) return [{ from: last.to, to: last.to, text: space + inner }];
  const outer = space ? indent(document.text, tag) || '\n' : '';
  if (tag.openTo === tag.to) {
    const open = document.text.slice(tag.from, tag.to - 2).trimEnd().length;
    const text = `>${space}${inner}${outer}</${tag.name}>`;
    return [{ from: tag.from + open, to: tag.to, text }];
  }
  // Only space is in it, or a text or comment that stays before.
  const isEmpty = document.text.slice(tag.openTo, tag.closeFrom).trim() === '';
  const from = isEmpty ? tag.openTo : tag.closeFrom;
  return [{ from, to: tag.closeFrom, text: `${space}${inner}${outer}` }];
}

/** Takes a tag away, with its line if nothing else is in it. */
export function remove({ text }: XmlDocument, tag: Tag): Splice[] {
  return [{ from: tag.from - indent(text, tag).length, to: tag.to, text: '' }];
}

/** Puts a text where a tag is, which goes. */
export function replace({ text }: XmlDocument, tag: Tag, xml: string): Splice[] {
  const space = indent(text, tag);
  return [{ from: tag.from, to: tag.to, text: space ? xml.replaceAll('\n', space) : xml }];
}

/** Two tags change places. */
export function swap({ text }: XmlDocument, one: Tag, other: Tag): Splice[] {
  return [
    { from: one.from, to: one.to, text: text.slice(other.from, other.to) },
    { from: other.from, to: other.to, text: text.slice(one.from, one.to) },
  ];
}

/** Line and column of a letter, from 1. */
export function placeOf(text: string, at: number): { line: number; column: number } {
  const before = text.slice(0, at);
  const begin = before.lastIndexOf('\n') + 1;
  return { line: before.split('\n').length, column: at - begin + 1 };
}

/** The letter at a line and column, from 1. */
export function letterAt(text: string, line: number, column: number): number {
  let begin = 0;
  for (let number = 1; number < line; number += 1) {
    const end = text.indexOf('\n', begin);
    if (end < 0) break;
    begin = end + 1;
  }
  return Math.min(begin + column - 1, text.length);
}

/** The innermost tag at a letter. */
export function tagAt(root: Tag, at: number): Tag | undefined {
  if (at < root.from || at >= root.to) return undefined;
  let found = root;
  for (;;) {
    const inner = found.children.find(({ from, to }) => from <= at && at < to);
    if (!inner) return found;
    found = inner;
  }
}
