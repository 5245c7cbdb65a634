// The studio as static files, served as any web server would: what its tests share.
//
// STUDIO is the folder that web/site.sh has built, TRIK_STUDIO_PACKAGE the package in it, for what tests compare with.

import { readFileSync } from 'node:fs';
import { createServer, type Server } from 'node:http';
import { join, normalize, resolve } from 'node:path';
import type { Draft } from '../src/studio/engine/package';

export const SITE = resolve(process.env['STUDIO'] ?? join(import.meta.dirname, '../../../target/web/site'));
const PACKAGE = resolve(
  process.env['TRIK_STUDIO_PACKAGE'] ?? join(import.meta.dirname, '../../../target/web/package'),
);
/** Real projects, if they are there. */
export const DATA = resolve(import.meta.dirname, '../../../../shared/data');

const TYPES: Record<string, string> = {
  html: 'text/html; charset=utf-8',
  js: 'text/javascript',
  mjs: 'text/javascript',
  css: 'text/css',
  wasm: 'application/wasm',
  svg: 'image/svg+xml',
  webmanifest: 'application/manifest+json',
};

/** A server of the files below a folder of its address, so that nothing of the page needs the root. */
export class Site {
  readonly #server: Server;
  /** Paths that were asked for. */
  readonly asked: string[] = [];

  private constructor(folder: string) {
    this.#server = createServer((request, response) => {
      const path = normalize(decodeURIComponent(new URL(request.url ?? '', 'http://site').pathname));
      this.asked.push(path);
      const name = path.replace(/^\/school\/studio\//, '') || 'index.html';
      response.setHeader('content-type', TYPES[name.split('.').at(-1) ?? ''] ?? 'application/octet-stream');
      try {
        response.end(readFileSync(join(folder, name)));
      } catch {
        response.statusCode = 404;
        response.end();
      }
    });
  }

  static async start(folder = SITE): Promise<Site> {
    const site = new Site(folder);
    await new Promise<void>((done) => site.#server.listen(0, '127.0.0.1', done));
    return site;
  }

  get url(): string {
    const address = this.#server.address();
    const port = typeof address === 'object' ? address?.port : 0;
    return `http://127.0.0.1:${port}/school/studio/`;
  }

  async end(): Promise<void> {
    this.#server.closeAllConnections();
    await new Promise((done) => this.#server.close(done));
  }
}

type Package = typeof import('../src/studio/engine/package');

/** The package in this process. */
export function library(): Promise<Package> {
  return import(/* @vite-ignore */ join(PACKAGE, 'node.js')) as Promise<Package>;
}

/** A save as a draft. */
export async function drafted(bytes: Uint8Array): Promise<Draft> {
  const opened = (await library()).edit('task.qrs', bytes);
  if (!opened.ok) throw new Error(opened.error.problems[0]?.message);
  return opened.value;
}
