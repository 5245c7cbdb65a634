// The world of the draft that is edited: its text, the things in it, what is chosen.
//
// Owns the way from a change to the draft and back. Changes are those of the draft, so that they are taken back as all others.

import type { Finding } from '../engine/facts';
import type { Studio } from '../studio.svelte';
import { KINDS, type KindName, isPicture, pictureRect } from './kinds';
import {
  type Item,
  NEW_WORLD,
  type WorldFault,
  type WorldModel,
  added,
  changed,
  isFault,
  model,
  without,
} from './model';
import { type Chosen, newId, withImage, withoutImages } from './pictures';
import type { Spot } from './units';
import { type Splice, type Tag, letterAt, placeOf, spliced, tagAt } from './xml';

export class WorldDraft {
  /** Undefined: the project has no world. */
  text = $state.raw<string | undefined>(undefined);
  /** It was read once. */
  isRead = $state(false);
  /** Which project it is that of: another number for another one. */
  project = $state(-1);
  /** The key of a thing. */
  chosen = $state('');
  /** What the next stroke on the sheet makes. */
  tool = $state<KindName | undefined>(undefined);
  snaps = $state(true);
  /** Rules are shown as text. */
  isText = $state(false);
  /** A line of the rules' text that is to be seen. */
  line = $state.raw<{ line: number } | undefined>(undefined);
  #before: WorldModel | undefined;
  /** Of the change that was made last. */
  #number = 0;

  constructor(readonly studio: Studio) {
    // Whatever has changed it: a hand, taking back, another project.
    $effect(() => {
      if (studio.drawing && studio.part !== 'program') void this.#look();
    });
    $effect(() => {
      void studio.opened;
      this.chosen = '';
      this.tool = undefined;
    });
    $effect(() => {
      const { sought } = studio;
      if (sought && this.isRead) this.#seek(sought);
    });
  }

  readonly #read = $derived.by((): WorldModel | WorldFault | undefined => {
    if (this.text === undefined) return undefined;
    const found = model(this.text, this.#before);
    if (!isFault(found)) this.#before = found;
    return found;
  });

  get model(): WorldModel | undefined {
    return this.#read && !isFault(this.#read) ? this.#read : undefined;
  }

  /** Why its text is no world, and where. */
  get fault(): (WorldFault & { line: number; column: number }) | undefined {
    const read = this.#read;
    return read && isFault(read) ? { ...read, ...placeOf(this.text ?? '', read.at) } : undefined;
  }

  /** It is that of a task, or there is none. */
  get isFixed(): boolean {
    return this.studio.hasTask;
  }

  get item(): Item | undefined {
    return this.model?.byKey.get(this.chosen);
  }

  /** The tags that findings are about. */
  readonly tagged = $derived.by((): { finding: Finding; tag: Tag }[] =>
    this.studio.worldFindings.flatMap((finding) => {
      const tag = this.#tagOf(finding);
      return tag ? [{ finding, tag }] : [];
    }),
  );

  /** The worst finding of each thing. */
  readonly findings = $derived.by((): ReadonlyMap<string, Finding> => {
    const keys = new Map([...(this.model?.tags ?? [])].map(([key, tag]) => [tag, key]));
    const found = new Map<string, Finding>();
    for (const { finding, tag } of this.tagged) {
      for (let at: Tag | undefined = tag; at; at = at.outside) {
        const key = keys.get(at);
        if (key === undefined) continue;
        if (!found.has(key)) found.set(key, finding);
        break;
      }
    }
    return found;
  });

  /** The tag that a finding is about. */
  #tagOf({ line, column }: Finding): Tag | undefined {
    const found = this.model;
    if (!found || line === null) return undefined;
    return tagAt(found.document.root, letterAt(found.document.text, line, column ?? 1));
  }

  /** Makes a change: one step to be taken back. */
  async change(splices: readonly Splice[]): Promise<void> {
    if (this.text === undefined || splices.length === 0) return;
    await this.put(spliced(this.text, splices));
  }

  /** Adds a picture that shows an image of the person: one step to be taken back. The key that it has. */
  async addPicture(chosen: Chosen, from: Spot, to: Spot): Promise<string | undefined> {
    const found = this.model;
    const kind = KINDS.find(({ name }) => name === 'image');
    const kept = await this.#withImage(chosen);
    if (!found || !kind || !kept) return undefined;
    const { splices, key } = added(found, kind, from, to, { imageId: kept.id });
    await this.put(spliced(found.document.text, splices), kept.images);
    return key;
  }

  /** A picture shows another image, as wide as before. */
  async changePicture({ key }: Item, chosen: Chosen): Promise<void> {
    const kept = await this.#withImage(chosen);
    // As it is by now: the world may have changed meanwhile.
    const item = this.model?.items.find((one) => one.key === key);
    if (!this.model || !item || !kept) return;
    const { values } = item;
    const name = pictureRect(values);
    const [left = 0, top = 0, width = 0] = values.lengths(name, 4);
    const high = (Math.abs(width) * chosen.height) / chosen.width;
    const place = values.writePoint(left, top, width, high);
    const splices = changed(this.model, item.key, { imageId: kept.id, [name]: place });
    await this.put(spliced(this.model.document.text, splices), this.#without(kept.images, item));
  }

  /** Takes a thing away; the image of a picture goes with the last one that shows it. */
  async remove(item: Item): Promise<void> {
    const { model: found } = this;
    if (!found) return;
    const text = spliced(found.document.text, without(found, item.key));
    if (!isPicture(item)) {
      await this.put(text);
      return;
    }
    const images = await this.studio.images();
    await this.put(text, this.#without(images, item));
  }

  /** Images without that of a picture, if no other picture shows it. */
  #without(images: string, item: Item): string {
    const id = item.values.text('imageId');
    const others = (this.model?.items ?? []).filter((one) => one.key !== item.key && isPicture(one));
    return others.some(({ values }) => values.text('imageId') === id)
      ? images
      : withoutImages(images, new Set([id]));
  }

  async #withImage({ path, text }: Chosen): Promise<{ id: string; images: string } | undefined> {
    if (this.isFixed) return undefined;
    const id = newId();
    const images = withImage(await this.studio.images(), { id, path, text });
    return images === undefined ? undefined : { id, images };
  }

  async make(): Promise<void> {
    await this.put(NEW_WORLD);
  }

  /** Another text, perhaps with other images. What is shown is that at once; what the draft refuses, which is told, is as it was before. */
  async put(text: string, images?: string): Promise<boolean> {
    if (this.isFixed || text === this.text) return true;
    this.text = text;
    this.#number += 1;
    await this.studio.apply({ do: 'world', text, ...(images === undefined ? {} : { images }) });
    return this.studio.refusal === '';
  }

  async #look(): Promise<void> {
    const number = this.#number;
    const text = await this.studio.world();
    // A later change has its own look.
    if (number !== this.#number) return;
    // Some saves have an empty one.
    this.text = text?.trim() ? text : undefined;
    this.isRead = true;
    this.project = this.studio.opened;
  }

  /** The place of a finding: the thing, or the line of the rules. */
  #seek(finding: Finding): void {
    const found = this.model;
    this.studio.sought = undefined;
    const tag = this.#tagOf(finding);
    if (!found || !tag) return;
    const { constraints } = found;
    if (constraints && tag.from >= constraints.from && tag.to <= constraints.to) {
      this.studio.turnTo('rules');
      this.isText = true;
      this.line = { line: (finding.line ?? 1) - placeOf(found.document.text, constraints.from).line + 1 };
      return;
    }
    for (let at: Tag | undefined = tag; at; at = at.outside)
      for (const [key, one] of found.tags) if (one === at) this.#choose(key);
  }

  #choose(key: string): void {
    this.studio.turnTo('world');
    this.chosen = key;
  }
}
