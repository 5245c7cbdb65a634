// A save of TRIK Studio with blocks in a row, for tests that need a diagram which no file has.
//
// Owns the XML of a save and the zip around it, uncompressed.

import { crc32 } from 'node:zlib';

const NONE = 'qrm:/ROOT_ID/ROOT_ID/ROOT_ID/ROOT_ID';
const KIND = 'qrm:/RobotsMetamodel/RobotsDiagram';
const STEP = 200;

/** An id; odd numbers are graphical, the next even ones logical. */
const id = (/** @type {string} */ kind, /** @type {number} */ number) =>
  `${KIND}/${kind}/{00000000-0000-4000-8000-${String(number).padStart(12, '0')}}`;

const text = (/** @type {string} */ value) =>
  value.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('"', '&quot;').replaceAll('\n', '&#10;');
const string = (/** @type {string} */ key, /** @type {string} */ value) =>
  `<QString key="${key}" value="${text(value)}"/>`;
const list = (/** @type {string[]} */ ids) => ids.map((one) => `<object id="${one}"/>`).join('');

/**
 * Both halves of one element.
 * @param {{kind: string, number: number, properties: [string, string][], from?: [string, number], to?: [string, number],
 *   links?: number[], position?: string, parent?: string, children?: string[]}} one
 */
function element({ kind, number, properties, from, to, links = [], position, parent = NONE, children = [] }) {
  const end = (/** @type {[string, number] | undefined} */ of, /** @type {number} */ half) =>
    of ? id(of[0], of[1] + half) : NONE;
  const half = (/** @type {number} */ which, /** @type {string} */ more) =>
    `<properties>${more}<qReal::Id key="from" value="${end(from, which)}"/><links type="qReal::IdList">` +
    `${list(links.map((link) => id('ControlFlow', link + which)))}</links>` +
    `${string('name', kind === 'RobotsDiagramNode' ? 'main' : kind)}` +
    `<qReal::Id key="to" value="${end(to, which)}"/></properties></object>`;
  const [shown, meant] = [id(kind, number), id(kind, number + 1)];
  const place = position ? `<QPointF key="position" value="${position}"/>` : '';
  const own = properties.map(([key, value]) => string(key, value)).join('');
  return [
    {
      name: `tree/graphical/${shown.slice('qrm:/'.length)}`,
      text: `<object parent="${parent}" id="${shown}" logicalId="${meant}"><children>${list(children)}</children>${half(0, place)}`,
    },
    {
      name: `tree/logical/${meant.slice('qrm:/'.length)}`,
      text: `<object parent="${NONE}" id="${meant}"><children/>${half(1, own)}`,
    },
  ];
}

/**
 * The save of blocks that follow each other.
 * @param {[kind: string, properties: Record<string, string>][]} blocks
 */
export function sketch(blocks) {
  const diagram = id('RobotsDiagramNode', 1);
  const block = (/** @type {number} */ at) => 11 + 2 * at;
  const link = (/** @type {number} */ at) => 101 + 2 * at;
  const inside = blocks.flatMap(([kind, properties], at) =>
    element({
      kind,
      number: block(at),
      properties: Object.entries(properties),
      links: [at - 1, at].filter((one) => one >= 0 && one < blocks.length - 1).map(link),
      position: `${at * STEP}, 0`,
      parent: diagram,
    }),
  );
  const links = blocks.slice(1).flatMap(([kind], at) =>
    element({
      kind: 'ControlFlow',
      number: link(at),
      properties: [['Guard', '']],
      from: [blocks[at]?.[0] ?? '', block(at)],
      to: [kind, block(at + 1)],
      parent: diagram,
    }),
  );
  const ids = (/** @type {string} */ half) =>
    [...inside, ...links]
      .filter(({ name }) => name.startsWith(`tree/${half}/`))
      .map(({ name }) => name.replace(`tree/${half}/`, 'qrm:/'));
  const main = element({ kind: 'RobotsDiagramNode', number: 1, properties: [], children: ids('graphical') });
  const roots = [diagram, id('RobotsDiagramNode', 2), ...ids('logical')];
  const root = {
    name: 'tree/logical/ROOT_ID/ROOT_ID/ROOT_ID/ROOT_ID',
    text: `<object parent="qrm:/" id="${NONE}"><children>${list(roots)}</children><properties/></object>`,
  };
  const about = {
    name: 'metaInfo.xml',
    text: '<metaInformation><info key="RobotsMetamodelVersion" value="2024.1.0" type="QString"/></metaInformation>',
  };
  return zip([root, ...main, ...inside, ...links, about]);
}

/** @param {{name: string, text: string}[]} files */
function zip(files) {
  /** @type {Buffer[]} */
  const [parts, index] = [[], []];
  let at = 0;
  for (const file of files) {
    const [name, data] = [Buffer.from(file.name), Buffer.from(file.text)];
    // Version, flags, method, time, date; checksum and both sizes.
    const head = Buffer.alloc(26);
    head.writeUInt16LE(20, 0);
    head.writeUInt16LE(33, 8);
    head.writeUInt32LE(crc32(data), 10);
    head.writeUInt32LE(data.length, 14);
    head.writeUInt32LE(data.length, 18);
    head.writeUInt16LE(name.length, 22);
    const place = Buffer.alloc(14);
    place.writeUInt32LE(at, 10);
    parts.push(Buffer.from('PK\x03\x04'), head, name, data);
    index.push(Buffer.from('PK\x01\x02'), Buffer.from([20, 0]), head, place, name);
    at += 30 + name.length + data.length;
  }
  const end = Buffer.alloc(18);
  end.writeUInt16LE(files.length, 4);
  end.writeUInt16LE(files.length, 6);
  end.writeUInt32LE(Buffer.concat(index).length, 8);
  end.writeUInt32LE(at, 12);
  return Buffer.concat([...parts, ...index, Buffer.from('PK\x05\x06'), end]);
}
