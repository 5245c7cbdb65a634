// The world in a browser, around robots of `trik up`. SHOTS is a folder for pictures.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { afterAll, beforeAll, test } from 'vitest';
import { barriers, eventually, Look, Robot } from './robot.js';

/** @type {Look} */
let eyes;

beforeAll(async () => {
  eyes = await Look.start();
});

afterAll(async () => {
  await eyes.end();
});

/** A world with many things, for measurements: 100 walls, 100 balls, lines and a region. */
function crowd() {
  let walls = '';
  let balls = '';
  let lines = '';
  for (let at = 0; at < 100; at++) {
    const [x, y] = [300 + (at % 10) * 60, -300 + Math.floor(at / 10) * 60];
    walls += `<wall id="w${at}" begin="${x}:${y}" end="${x + 30}:${y + 10}"/>`;
    const place = `x="${x + 15}" y="${y + 35}"`;
    balls += `<ball id="b${at}" ${place} markerX="${x + 15}" markerY="${y + 35}" rotation="0" startRotation="0"/>`;
    lines += `<line id="l${at}" begin="${x}:${y + 50}" end="${x + 40}:${y + 50}" stroke="#ff000000" stroke-width="6"/>`;
  }
  const region =
    '<region id="r" type="ellipse" x="-80" y="-80" width="200" height="200" filled="true" visible="true" text="start"/>';
  return (
    `<root version="20251219"><settings realisticPhysics="true"/><world><walls>${walls}</walls><balls>${balls}</balls>` +
    `<colorFields>${lines}</colorFields><regions>${region}</regions></world></root>`
  );
}

/** Waits until something holds, and says what it was. */
async function until(what, read, holds) {
  let last;
  await eventually(what, async () => holds((last = await read())));
  return last;
}

/** A browser of its own that looks at the world. `state` is the newest message of the server about it. */
async function look(robot, options = {}) {
  const seen = { scene: undefined, state: undefined, scenes: 0, states: 0, refused: [] };
  const hear = (page) =>
    page.on('websocket', (socket) =>
      socket.on('framereceived', ({ payload }) => {
        if (typeof payload !== 'string') return;
        const news = JSON.parse(payload);
        if (news.is === 'scene') [seen.scene, seen.scenes] = [news.scene, seen.scenes + 1];
        if (news.is === 'world') [seen.state, seen.states] = [news.state, seen.states + 1];
        if (news.is === 'refused') seen.refused.push(news.why);
      }),
    );
  const page = await eyes.open(`${robot.url}#world`, options, hear);
  await page.locator('.stage canvas').waitFor();
  await until('the world', () => seen.state, Boolean);
  return { page, seen, context: page.context() };
}

/** The middle of all pixels of the robot's colour, in pixels of the page; null if there are none. */
function whereIsIt(page) {
  return page.evaluate(() => {
    const canvas = document.querySelector('.stage canvas');
    const { width, height } = canvas;
    const { data } = canvas.getContext('2d').getImageData(0, 0, width, height);
    let [count, x, y] = [0, 0, 0];
    for (let at = 0; at < data.length; at += 4) {
      // The arrow ahead has the colour of the robot.
      if (data[at] === 0xc2 && data[at + 1] === 0x18 && data[at + 2] === 0x5b) {
        count += 1;
        x += (at / 4) % width;
        y += Math.floor(at / 4 / width);
      }
    }
    const scale = canvas.clientWidth / width;
    return count < 20 ? null : { x: (x / count) * scale, y: (y / count) * scale, count };
  });
}

async function accessible(page, what) {
  assert.deepEqual(await barriers(page), [], what);
}

async function shot(page, name) {
  if (process.env.SHOTS) await page.screenshot({ path: join(process.env.SHOTS, `${name}.png`) });
}

function drive(robot, left, right) {
  robot.write('motors/M3/value', left);
  robot.write('motors/M4/value', right);
}

/** Two fingers that go apart make the robot larger, and one carries it. */
async function pinch(page) {
  await page.getByRole('checkbox').uncheck();
  const fingers = await page.context().newCDPSession(page);
  const box = await page.locator('.stage canvas').boundingBox();
  const touch = (type, ...points) =>
    fingers.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: points.map(([x, y], id) => ({ x: box.x + x, y: box.y + y, id })),
    });
  const before = await until('the robot', () => whereIsIt(page), Boolean);
  await touch('touchStart', [40, 20]);
  await touch('touchStart', [40, 20], [80, 20]);
  for (let step = 1; step <= 10; step++) await touch('touchMove', [40 - 2 * step, 20], [80 + 2 * step, 20]);
  await touch('touchEnd');
  await until(
    'a larger robot',
    () => whereIsIt(page),
    (after) => after !== null && after.count > 2 * before.count,
  );
  const from = await whereIsIt(page);
  await touch('touchStart', [from.x, from.y]);
  for (let step = 1; step <= 10; step++) await touch('touchMove', [from.x + 6 * step, from.y]);
  await touch('touchEnd');
  await until(
    'a carried robot',
    () => whereIsIt(page),
    (at) => at !== null && at.x > from.x + 40,
  );
}

/** The shipped robot in its room. */
async function room(one) {
  const { page, seen, context } = await look(one);
  // The way of the robot has its colour too.
  await page.getByLabel('Trail', { exact: true }).uncheck();
  const first = await until('the robot on the picture', () => whereIsIt(page), Boolean);
  await shot(page, 'room');
  await accessible(page, 'the world');

  drive(one, 40, 40);
  await until(
    'a robot that drives',
    () => whereIsIt(page),
    (at) => at !== null && at.x > first.x + 20,
  );
  drive(one, 0, 0);
  await page.getByText(/The robot is at x 0\.[89]\d m|The robot is at x 1\.\d+ m/).waitFor();

  await page.getByRole('button', { name: 'Pause' }).click();
  await page.getByRole('button', { name: 'Go on' }).waitFor();
  const still = seen.state.t;
  // In this time four pictures would come.
  await new Promise((done) => setTimeout(done, 400));
  assert.equal(seen.state.t, still, 'time stands still');
  await page.getByRole('button', { name: 'Step' }).click();
  await until(
    'a step',
    () => seen.state.t,
    (time) => Math.abs(time - still - 0.1) < 0.002,
  );
  await page.getByRole('button', { name: 'Go on' }).click();
  await page.getByLabel('Speed').selectOption('2');
  await until(
    'twice as fast',
    () => seen.state.speed,
    (speed) => speed === 2,
  );

  // With the mouse.
  const box = await page.locator('.stage canvas').boundingBox();
  const from = await whereIsIt(page);
  await page.mouse.move(box.x + from.x, box.y + from.y);
  await page.mouse.down();
  await page.mouse.move(box.x + from.x + 100, box.y + from.y + 150, { steps: 20 });
  await page.mouse.up();
  await until(
    'a robot that was dragged',
    () => whereIsIt(page),
    (at) => at !== null && Math.hypot(at.x - from.x - 100, at.y - from.y - 150) < 6,
  );
  // By keys.
  const before = seen.state.robots[0].at;
  await page.locator('.stage').focus();
  await page.keyboard.press('Shift+ArrowLeft');
  await page.keyboard.press(',');
  await until(
    'a robot that keys carry',
    () => seen.state.robots[0].at,
    (at) => Math.abs(at[0] - before[0] + 0.05) < 0.01 && Math.abs(at[2] - before[2] - 15) < 0.1,
  );
  await page.getByRole('button', { name: 'Reset' }).click();
  await until(
    'a reset',
    () => seen.state.robots[0].at,
    (at) => String(at) === '0.8,1,0',
  );

  // A fault by clicks, and back.
  await page.getByText('Faults').click();
  await page.getByRole('combobox', { name: 'Device' }).selectOption('D1');
  await page.getByRole('combobox', { name: 'Fault', exact: true }).selectOption('unplug');
  await page.getByRole('button', { name: 'Break it' }).click();
  await until(
    'a fault',
    () => seen.state.faults.D1,
    (what) => what === 'unplug',
  );
  await shot(page, 'fault');
  await accessible(page, 'faults');
  await page.getByRole('button', { name: 'Mend D1' }).click();
  await until(
    'no fault',
    () => seen.state.faults.D1,
    (what) => what === undefined,
  );

  // Nobody looks: nothing comes.
  await page.evaluate(() => (location.hash = 'instruments'));
  // In this time four pictures would come.
  const more = async () => {
    const { states } = seen;
    await new Promise((done) => setTimeout(done, 400));
    return seen.states - states;
  };
  await until('silence where nobody looks', more, (count) => count === 0);
  assert.deepEqual(seen.refused, []);
  await context.close();
  for (const [name, options] of [
    ['dark', { colorScheme: 'dark' }],
    ['narrow', { viewport: { width: 400, height: 800 }, hasTouch: true, isMobile: true, locale: 'ru' }],
  ]) {
    const other = await look(one, options);
    const [x, y] = other.seen.state.robots[0].at;
    drive(one, 30, 50);
    await until(
      'a way that can be seen',
      () => other.seen.state.robots[0].at,
      (at) => Math.hypot(at[0] - x, at[1] - y) > 0.15,
    );
    drive(one, 0, 0);
    await shot(other.page, name);
    if (options.hasTouch) await pinch(other.page);
    const wide = await other.page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(wide <= 0, `${name}: nothing is beside the screen, ${wide} px`);
    await accessible(other.page, name);
    await other.context.close();
  }
}

/** A world of TRIK Studio: another one is dropped, and how long a picture takes. */
async function crowded(one) {
  const { page, seen } = await look(one);
  const dropped = await page.evaluateHandle((text) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([text], 'crowd.xml', { type: 'text/xml' }));
    return transfer;
  }, crowd());
  await page.locator('main section').dispatchEvent('drop', { dataTransfer: dropped });
  await until(
    'another world',
    () => seen.scene.things.length,
    (count) => count === 100,
  );
  await until(
    'its state',
    () => seen.state.things.length,
    (count) => count === 100,
  );
  await page
    .locator('input[type=file]')
    .setInputFiles({ name: 'x.xml', mimeType: 'text/xml', buffer: Buffer.from('<root') });
  await until(
    'a refusal',
    () => seen.refused.length,
    (count) => count === 1,
  );
  assert.equal(seen.scene.things.length, 100, 'what is no world changes nothing');
  drive(one, 60, 55);
  const browserSays = await page.context().newCDPSession(page);
  await browserSays.send('Performance.enable');
  /** Milliseconds of scripts since the page was opened. */
  const scripts = async () => {
    const { metrics } = await browserSays.send('Performance.getMetrics');
    return 1000 * metrics.find(({ name }) => name === 'ScriptDuration').value;
  };
  // From one picture of the screen to the next one, and what of it the scripts took.
  const measure = async (doing) => {
    const before = await scripts();
    const times = page.evaluate(
      () =>
        new Promise((done) => {
          const times = [];
          const next = (now) => {
            times.push(now);
            if (times.length < 181) return requestAnimationFrame(next);
            return done(times.slice(1).map((time, at) => time - times[at]));
          };
          requestAnimationFrame(next);
        }),
    );
    await doing();
    const sorted = (await times).sort((one, other) => one - other);
    const share = ((await scripts()) - before) / sorted.length;
    return `median ${sorted[90].toFixed(1)} ms, slowest of 180 ${sorted[179].toFixed(1)} ms, scripts ${share.toFixed(1)} ms each`;
  };
  console.info(`pictures with 300 things while it drives: ${await measure(async () => {})}`);
  await page.locator('.stage').focus();
  const pan = async () => {
    for (let at = 0; at < 60; at++) await page.keyboard.press(at % 2 ? 'ArrowLeft' : 'ArrowRight');
  };
  console.info(`and while it is panned: ${await measure(pan)}`);
  await shot(page, 'crowd');
}

/** A robot for one test. */
async function around(args, body) {
  const one = await Robot.start(...args);
  try {
    await body(one);
  } finally {
    await one.end();
  }
}

test('the robot in its room is seen, carried, held and broken', () => around([], room), 180_000);

test('a world of TRIK Studio is replaced by one that is dropped', async () => {
  const empty = join(import.meta.dirname, 'empty.xml');
  await around(['--field', empty], crowded);
}, 180_000);

test('no page has complained', () => {
  assert.deepEqual(eyes.complaints, []);
});
