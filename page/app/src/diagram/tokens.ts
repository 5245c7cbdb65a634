// What stands at the ports of a picture of data flow: the last token of an output, and what waits or was lost at an input.
//
// Owns a layer over the picture, so that a large picture is not painted anew for each token. The same stands beside it for those
// who do not see it, so screen readers skip this.

import { TOKEN_LETTERS_MAX } from '../limits';
import { words } from '../words';
import { type PortFacts, short } from './flow';
import type { BlockFacts, PortSpot } from './sheet';

const SVG = 'http://www.w3.org/2000/svg';
/** From a port to its text, in px of the picture. */
const BESIDE = 7;
const ABOVE = 4;

export class Tokens {
  readonly layer = document.createElementNS(SVG, 'svg');
  readonly #texts = new Map<string, SVGTextElement>();

  constructor(
    picture: SVGSVGElement,
    private readonly places: ReadonlyMap<string, SVGGElement>,
    private readonly facts: Readonly<Record<string, BlockFacts>>,
  ) {
    this.layer.setAttribute('viewBox', picture.getAttribute('viewBox') ?? '');
    this.layer.setAttribute('class', 'tokens');
    this.layer.setAttribute('aria-hidden', 'true');
  }

  /** Ports of other sheets have no place here. */
  show(ports: readonly PortFacts[]): void {
    const stays = new Set<string>();
    for (const one of ports) {
      const said = says(one);
      if (!said.text) continue;
      const element = this.#texts.get(one.key) ?? this.#add(one);
      if (!element) continue;
      stays.add(one.key);
      if (element.textContent !== said.text) element.textContent = said.text;
      if (element.getAttribute('class') !== said.kind) element.setAttribute('class', said.kind);
    }
    for (const [key, element] of this.#texts) {
      if (stays.has(key)) continue;
      element.remove();
      this.#texts.delete(key);
    }
  }

  #add(one: PortFacts): SVGTextElement | undefined {
    const spot = this.#spot(one);
    const box = this.places.get(one.id)?.querySelector('rect');
    if (!spot || !box) return undefined;
    const beside = spot.gives ? BESIDE : -BESIDE;
    const element = document.createElementNS(SVG, 'text');
    element.setAttribute('x', String(Number(box.getAttribute('x')) + spot.x + beside));
    element.setAttribute('y', String(Number(box.getAttribute('y')) + spot.y - ABOVE));
    this.layer.append(element);
    this.#texts.set(one.key, element);
    return element;
  }

  #spot({ id, port }: PortFacts): PortSpot | undefined {
    const facts = Object.hasOwn(this.facts, id) ? this.facts[id] : undefined;
    return facts?.ports?.find(({ name }) => name === port);
  }
}

/** What stands at a port, and its class. */
function says({ last, waiting, lost }: PortFacts): { text: string; kind: string } {
  if (waiting > 0 || lost > 0) {
    const parts = [waiting > 0 ? words.waitingAt(waiting) : '', lost > 0 ? words.lostAt(lost) : ''];
    return { text: parts.filter(Boolean).join(', '), kind: lost > 0 ? 'waits lost' : 'waits' };
  }
  return { text: short(last ?? '', TOKEN_LETTERS_MAX), kind: 'last' };
}
