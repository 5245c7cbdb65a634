// One drawing of the world for each picture of the screen, as long as somebody can see it.
//
// Owns the loop, the camera and the trail. What is drawn is known to `floor` and `moving`.

import type { Around } from './around';
import { Camera } from './camera';
import { Floor } from './floor';
import type { Heat } from './heat';
import { drawMoving } from './moving';
import { Trail } from './trail';
import type { Place, Scene, WorldState } from './types';

/** Sharper pictures cost more than they show. */
const RATIO_MAX = 2;

/** What is drawn. */
export interface Drawable {
  readonly scene: Scene | undefined;
  readonly world: WorldState | undefined;
  /** What makes both of something else at each picture. */
  readonly around: Around | undefined;
  /** Between the floor and all that moves. */
  readonly heat?: Heat | undefined;
}

export class View {
  readonly camera = new Camera();
  /** Of a world that does not know the ways itself. */
  readonly #ways = new Trail();
  hasTrail = true;
  /** What keys move: 0 is the robot, then things from 1; shown while the picture has the focus. */
  picked = 0;
  showsPicked = false;
  readonly #floor = new Floor(() => (this.#isDirty = true));
  #isDirty = true;
  #scene: Scene | undefined;
  #state: WorldState | undefined;
  #frame = 0;

  constructor(
    private readonly drawable: Drawable,
    private readonly canvas: HTMLCanvasElement,
  ) {}

  /** Draws at each picture from now on. */
  start(): void {
    if (this.#frame !== 0) return;
    const next = () => {
      this.#frame = requestAnimationFrame(next);
      this.#look();
    };
    next();
  }

  stop(): void {
    cancelAnimationFrame(this.#frame);
    this.#frame = 0;
  }

  /** Everything is drawn again at the next picture. */
  touch(): void {
    this.#isDirty = true;
  }

  /** All of the world is seen. */
  fit(): void {
    if (this.#scene) this.camera.fit(this.#scene.bounds);
    this.touch();
  }

  resize(width: number, height: number): void {
    const isFirst = this.camera.width <= 1;
    this.camera.resize(width, height);
    if (isFirst) this.fit();
    this.touch();
  }

  get ratio(): number {
    return Math.min(RATIO_MAX, window.devicePixelRatio || 1);
  }

  /** The ways of robots, and what markers have left. */
  get trail(): Trail {
    return this.drawable.around?.trail ?? this.#ways;
  }

  /** Nothing is known of the ways until now. */
  #forget(): void {
    this.#ways.clear();
    this.#ways.told();
  }

  #look(): void {
    this.drawable.around?.look();
    const { scene, world } = this.drawable;
    if (!scene || !world || this.camera.width <= 1) return;
    if (scene !== this.#scene) {
      const isNew = String(this.#scene?.bounds) !== String(scene.bounds);
      this.#scene = scene;
      this.#ways.told();
      if (isNew) this.fit();
      this.#isDirty = true;
    }
    if (world !== this.#state) {
      // A recording that goes back begins another way.
      if (this.#state && world.t < this.#state.t) this.#forget();
      this.#state = world;
      if (!this.drawable.around?.trail) this.#ways.put(world);
      this.#isDirty = true;
    }
    if (!this.#isDirty) return;
    this.#isDirty = false;
    this.#draw(scene, world);
  }

  #draw(scene: Scene, world: WorldState): void {
    const { canvas, camera, ratio } = this;
    const width = Math.round(camera.width * ratio);
    const height = Math.round(camera.height * ratio);
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    const context = canvas.getContext('2d', { alpha: false });
    if (!context) return;
    this.#floor.draw(context, scene, camera, ratio);
    context.setTransform(...camera.matrix(ratio));
    const scale = camera.scale * ratio;
    this.drawable.heat?.draw(context);
    // Ways would hide it.
    const hasTrail = this.hasTrail && !this.drawable.heat;
    drawMoving(context, scene, world, hasTrail ? this.trail : undefined, scale);
    if (this.showsPicked) this.#ring(context, scene, world, scale);
  }

  /** Around what keys move. */
  #ring(context: CanvasRenderingContext2D, scene: Scene, world: WorldState, scale: number): void {
    const at: Place | undefined = this.picked === 0 ? world.robots[0]?.at : world.things[this.picked - 1];
    const size =
      this.picked === 0
        ? Math.max(...(scene.robots[0]?.size ?? [0]))
        : (scene.things[this.picked - 1]?.size ?? 0);
    if (!at) return;
    context.beginPath();
    context.arc(at[0], at[1], size / 2 + 8 / scale, 0, 2 * Math.PI);
    context.strokeStyle = '#ff6f00';
    context.lineWidth = 3 / scale;
    context.setLineDash([8 / scale, 5 / scale]);
    context.stroke();
    context.setLineDash([]);
  }
}
