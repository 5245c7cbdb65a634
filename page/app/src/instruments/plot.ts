// The drawing of a graph, by uPlot.
//
// Owns axes, colours and the size; what is drawn is given to it. Colours are those of the page, read at each drawing, so that it
// follows the scheme of the system.

import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { axisText } from './numbers';
import type { Joined } from './series';

/** A line of the graph. */
export interface Trace {
  label: string;
  unit: string;
  /** Its place among the colours. */
  line: number;
  /** It is of what is compared: the same colour, other dashes. */
  isOther: boolean;
}

/** A variable of the page's colours. */
export function colour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Lines differ by their dashes as well as by their colours. */
const DASHES = [[], [], [], [], [8, 4], [8, 4], [2, 3], [2, 3]];
const OTHER_DASHES = [
  [5, 5],
  [5, 5],
  [5, 5],
  [5, 5],
  [12, 3, 2, 3],
  [12, 3, 2, 3],
  [1, 5],
  [1, 5],
];

/** The variable with the colour of a line. */
export function lineColour(at: number): string {
  return `--line-${(at % 8) + 1}`;
}

const stepped = uPlot.paths.stepped?.({ align: 1 });

/** Units have a scale each; the first two have an axis. */
function scales(traces: readonly Trace[]): string[] {
  return [...new Set(traces.map((trace) => trace.unit))];
}

/** Between two times of the axis. */
const STEPS_S = [1, 2, 5, 10, 20, 30, 60];

/** Seconds of a clock of a day: the last part alone says enough. */
function clock(_: uPlot, splits: number[]): string[] {
  return splits.map((time) => {
    const date = new Date(time * 1000);
    return `${date.toLocaleTimeString('en-GB')}`;
  });
}

export class Plot {
  readonly #plot: uPlot;
  readonly #watch: ResizeObserver;
  readonly #scheme = matchMedia('(prefers-color-scheme: dark)');
  readonly #repaint = () => this.#plot.redraw(false);

  constructor(
    private readonly element: HTMLElement,
    private readonly traces: readonly Trace[],
    /** The time below the cursor; undefined without one. */
    point: (time: number | undefined) => void,
    /** Times are those of a day; else seconds from some beginning. */
    isClock = true,
  ) {
    const ink = () => colour('--dim');
    const grid = { stroke: () => colour('--line'), width: 1 };
    const units = scales(traces);
    const times = isClock ? { values: clock, space: 90, incrs: STEPS_S } : {};
    const axes: uPlot.Axis[] = [{ stroke: ink, grid, ticks: grid, ...times }];
    for (const [at, unit] of units.slice(0, 2).entries()) {
      axes.push({
        scale: `y${at}`,
        label: unit,
        labelSize: 18,
        side: at === 0 ? 3 : 1,
        stroke: ink,
        ticks: grid,
        grid: at === 0 ? grid : { show: false },
        size: 58,
        values: (_, splits) => splits.map((split) => axisText(split)),
      });
    }
    const options: uPlot.Options = {
      width: Math.max(element.clientWidth, 200),
      height: this.#height(),
      pxAlign: 0,
      legend: { show: false },
      cursor: { drag: { x: false, y: false }, points: { size: 6 } },
      scales: { x: { time: false, range: (_, min, max) => [min, max] } },
      axes,
      series: [
        {},
        ...traces.map((trace) => ({
          label: trace.label,
          scale: `y${units.indexOf(trace.unit)}`,
          stroke: () => colour(lineColour(trace.line)),
          width: 1.5,
          dash: (trace.isOther ? OTHER_DASHES : DASHES)[trace.line % DASHES.length] ?? [],
          points: { show: false },
          ...(stepped ? { paths: stepped } : {}),
        })),
      ],
      hooks: {
        setCursor: [
          (plot) => {
            const { left = -1 } = plot.cursor;
            point(left >= 0 ? plot.posToVal(left, 'x') : undefined);
          },
        ],
      },
    };
    this.#plot = new uPlot(options, [[], ...traces.map(() => [])], element);
    this.#watch = new ResizeObserver(() => {
      this.#plot.setSize({ width: Math.max(element.clientWidth, 200), height: this.#height() });
    });
    this.#watch.observe(element);
    this.#scheme.addEventListener('change', this.#repaint);
  }

  #height(): number {
    return Math.max(120, this.element.clientHeight);
  }

  /** Draws what there is from a time to a time. */
  show(joined: Joined, from: number, to: number): void {
    const data = [joined.times, ...joined.columns] as uPlot.AlignedData;
    this.#plot.batch(() => {
      this.#plot.setData(data, false);
      this.#plot.setScale('x', { min: from, max: to });
    });
  }

  /** The drawing, with the names of its lines below it, as it is to be saved. */
  picture(captions: readonly string[]): HTMLCanvasElement {
    const from = this.#plot.ctx.canvas;
    const ratio = devicePixelRatio || 1;
    const line = 18 * ratio;
    const canvas = document.createElement('canvas');
    canvas.width = from.width;
    canvas.height = from.height + line * (captions.length + 0.5);
    const pen = canvas.getContext('2d');
    if (!pen) return canvas;
    pen.fillStyle = colour('--raised');
    pen.fillRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(from, 0, 0);
    pen.font = `${13 * ratio}px sans-serif`;
    for (const [at, caption] of captions.entries()) {
      const y = from.height + line * (at + 0.7);
      const { line: place, isOther } = this.traces[at] ?? { line: at, isOther: false };
      pen.fillStyle = colour(lineColour(place));
      for (const [from, to] of isOther
        ? ([
            [10, 16],
            [20, 26],
          ] as const)
        : ([[10, 26]] as const))
        pen.fillRect(from * ratio, y - 6 * ratio, (to - from) * ratio, 4 * ratio);
      pen.fillStyle = colour('--ink');
      pen.fillText(caption, 34 * ratio, y);
    }
    return canvas;
  }

  close(): void {
    this.#watch.disconnect();
    this.#scheme.removeEventListener('change', this.#repaint);
    this.#plot.destroy();
  }
}
