// Tuples of bytes as numbers: by the format of a node, or as a person wants to read them.
//
// Owns how bytes become numbers, and the guess for those whose format nobody has told. Pure.

import { FIELDS_SHOWN_MAX } from '../limits';

/** How one number stands in a tuple; `>` before its kind: the high byte first. */
export interface Part {
  name: string;
  kind: string;
}

const SIZES: Record<string, number> = {
  i8: 1,
  u8: 1,
  i16: 2,
  u16: 2,
  i32: 4,
  u32: 4,
  i64: 8,
  u64: 8,
  f32: 4,
  f64: 8,
};
/** What a person may choose for bytes without a format. */
export const KINDS = [
  'u8',
  'i8',
  'u16',
  'i16',
  'u32',
  'i32',
  'f32',
  'f64',
  '>u16',
  '>i16',
  '>u32',
  '>i32',
  '>f32',
];

/** Bytes of one number; 0 for what is none. */
export function sizeOf(kind: string): number {
  return SIZES[kind.replace(/^[<>]/, '')] ?? 0;
}

/** The numbers of a format; none of a text. */
export function partsOf(format: string): Part[] {
  const whole = format.trim();
  const many = /^(\S+)\s+x\s+(\d+)$/.exec(whole);
  if (many) return uniform(many[1] ?? '', Number(many[2]) * sizeOf(many[1] ?? ''));
  const parts = whole.split(',', FIELDS_SHOWN_MAX).map((part) => {
    const [kind = '', name = ''] = part.trim().split(/\s+/);
    return { name, kind };
  });
  return parts.every(({ kind }) => sizeOf(kind) > 0) ? parts : [];
}

/** As many numbers of one kind as there is room for. */
export function uniform(kind: string, bytes: number): Part[] {
  const size = sizeOf(kind);
  const count = size === 0 ? 0 : Math.min(Math.floor(bytes / size), FIELDS_SHOWN_MAX);
  return Array.from({ length: count }, (_, at) => ({ name: String(at), kind }));
}

/** Bytes that these numbers take. */
function bytesOf(parts: readonly Part[]): number {
  return parts.reduce((sum, { kind }) => sum + sizeOf(kind), 0);
}

/**
 * The numbers of a tuple whose format nobody has told: those of the node if it has as many bytes, as filters keep it; else whole
 * ones of the size that devices and filters like.
 */
export function guessed(bytes: number, format: string): Part[] {
  const parts = partsOf(format);
  if (parts.length > 0 && bytesOf(parts) === bytes) return parts;
  if (bytes % 4 === 0 && bytes <= 64) return uniform('i32', bytes);
  return uniform(bytes === 2 ? 'u16' : 'u8', bytes);
}

/** The bytes of a tuple as the filesystem writes it; a large one is cut. */
export function bytesIn(hex: string): Uint8Array<ArrayBuffer> {
  const digits = hex.replace(/[^0-9a-f].*$/, '');
  return Uint8Array.from({ length: digits.length >> 1 }, (_, at) =>
    parseInt(digits.slice(2 * at, 2 * at + 2), 16),
  );
}

/** The numbers of a tuple; NaN for those that are not whole in it. */
export function numbersIn(bytes: Uint8Array<ArrayBuffer>, parts: readonly Part[]): number[] {
  const view = new DataView(bytes.buffer);
  let at = 0;
  return parts.map(({ kind }) => {
    const from = at;
    at += sizeOf(kind);
    return at > bytes.length ? NaN : numberAt(view, from, kind);
  });
}

function numberAt(view: DataView, at: number, kind: string): number {
  const isLittle = !kind.startsWith('>');
  switch (kind.replace(/^[<>]/, '')) {
    case 'i8':
      return view.getInt8(at);
    case 'u8':
      return view.getUint8(at);
    case 'i16':
      return view.getInt16(at, isLittle);
    case 'u16':
      return view.getUint16(at, isLittle);
    case 'i32':
      return view.getInt32(at, isLittle);
    case 'u32':
      return view.getUint32(at, isLittle);
    case 'i64':
      return Number(view.getBigInt64(at, isLittle));
    case 'u64':
      return Number(view.getBigUint64(at, isLittle));
    case 'f32':
      return view.getFloat32(at, isLittle);
    case 'f64':
      return view.getFloat64(at, isLittle);
    default:
      return NaN;
  }
}

/** Bytes for a person: in pairs, of a large tuple the beginning. */
export function hexText(hex: string, most = 32): string {
  const pairs = hex.match(/[0-9a-f]{2}/g) ?? [];
  const isCut = pairs.length > most || hex.endsWith('...');
  return pairs.slice(0, most).join(' ') + (isCut ? ' ...' : '');
}
