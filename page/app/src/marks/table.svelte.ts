// The marks of a class, and the way to their server.
//
// Owns what is known; how it looks is known to the components.

import { Link } from '../link/link';
import { BLANK, type Column, type News, type Progress, type Row } from './news';

const NOTHING: Progress = { done: 0, all: 0, over: false };

export class Table {
  name = $state('');
  pupils = $state.raw<string[]>([]);
  columns = $state.raw<Column[]>([]);
  passMark = $state.raw<number | null>(null);
  leftOut = $state.raw<string[]>([]);
  leftOutCount = $state(0);
  /** In the order of the pupils. */
  rows = $state.raw<Row[]>([]);
  progress = $state.raw<Progress>(NOTHING);
  isConnected = $state(false);
  /** There was a server: what it said last is shown when it is gone. */
  wasConnected = $state(false);
  /** What is judged is known. */
  isKnown = $state(false);
  readonly #link: Link<News, never>;

  constructor(address: string) {
    this.#link = new Link<News, never>(address, {
      connected: (is) => {
        this.isConnected = is;
        this.wasConnected ||= is;
      },
      news: (news) => this.#hear(news),
      message: () => undefined,
    });
  }

  /** Ends it for good. */
  close(): void {
    this.#link.close();
  }

  /** Points of columns count differently. */
  get hasWeights(): boolean {
    return this.columns.some(({ weight }) => weight !== 1);
  }

  #hear(news: News): void {
    switch (news.is) {
      case 'hello':
        this.isKnown = true;
        this.name = news.name;
        this.pupils = news.pupils;
        this.columns = news.columns;
        this.passMark = news.passMark;
        this.leftOut = news.leftOut;
        this.leftOutCount = news.leftOutCount;
        // Another command may have taken the place of the one that was here.
        this.rows = news.pupils.map(() => BLANK);
        this.progress = NOTHING;
        break;
      case 'row': {
        const { id, cells, sum, passed } = news;
        if (id < this.rows.length) this.rows = this.rows.with(id, { cells, sum, passed });
        break;
      }
      case 'progress':
        this.progress = { done: news.done, all: news.all, over: news.over };
        break;
      case 'beat':
        break;
    }
  }
}
