// What stands still as a picture of its own, which is painted again only when the scene or the part that is seen changes.
//
// Owns the canvas beside the visible one, and the pictures of the scene.

import { paint, type Step, steps } from './brush';
import type { Camera } from './camera';
import type { Scene } from './types';

/** Height of captions, in pixels of the page. */
const LETTERS = 13;

export class Floor {
  readonly #canvas = document.createElement('canvas');
  readonly #pictures = new Map<string, HTMLImageElement>();
  #scene: Scene | undefined;
  #steps: Step[] = [];
  #painted = '';

  /** Calls back when a picture has come, and all is to be drawn again. */
  constructor(private readonly came: () => void) {}

  /** Draws what stands still onto a picture of so many pixels in one of the page. */
  draw(onto: CanvasRenderingContext2D, scene: Scene, camera: Camera, ratio: number): void {
    if (scene !== this.#scene) {
      this.#scene = scene;
      this.#steps = steps(scene);
      this.#painted = '';
      this.#load();
    }
    const key = `${camera.key} ${ratio}`;
    if (key !== this.#painted) {
      this.#painted = key;
      this.#paint(scene, camera, ratio);
    }
    onto.setTransform(1, 0, 0, 1, 0, 0);
    onto.drawImage(this.#canvas, 0, 0);
  }

  #load(): void {
    this.#pictures.clear();
    for (const step of this.#steps) {
      if (step.is !== 'picture' || this.#pictures.has(step.address)) continue;
      const image = new Image();
      image.onload = () => {
        this.#painted = '';
        this.came();
      };
      image.src = step.address;
      this.#pictures.set(step.address, image);
    }
  }

  #paint(scene: Scene, camera: Camera, ratio: number): void {
    const width = Math.round(camera.width * ratio);
    const height = Math.round(camera.height * ratio);
    if (this.#canvas.width !== width) this.#canvas.width = width;
    if (this.#canvas.height !== height) this.#canvas.height = height;
    const context = this.#canvas.getContext('2d', { alpha: false });
    if (!context) return;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = '#ffffff';
    context.fillStyle = scene.floor;
    context.fillRect(0, 0, width, height);
    const matrix = camera.matrix(ratio);
    const scale = camera.scale * ratio;
    context.lineJoin = 'round';
    for (const step of this.#steps) {
      context.setTransform(...matrix);
      switch (step.is) {
        case 'path':
          paint(context, step, scale);
          break;
        case 'picture': {
          const image = this.#pictures.get(step.address);
          if (!image?.complete || image.naturalWidth === 0) break;
          // Pictures have y downwards.
          context.translate(step.left, step.top);
          context.scale(1, -1);
          context.drawImage(image, 0, 0, step.width, step.height);
          break;
        }
        case 'caption': {
          const { x, y } = camera.spot(step.x, step.y);
          context.setTransform(ratio, 0, 0, ratio, 0, 0);
          context.font = `${LETTERS}px sans-serif`;
          context.fillStyle = '#37474f';
          context.fillText(step.text, x + 4, y + LETTERS + 2);
          break;
        }
        default:
          step satisfies never;
      }
    }
  }
}
