class Robot {
    #speed = 3;
    get speed() { return this.#speed; }
    static make(...rest) { return new Robot(...rest); }
}
const { speed, ...others } = Robot.make();
let text = `speed ${new Robot().speed} ${speed ?? "unknown"}`;
print(text, others?.x?.y);
function* numbers() { yield* [1, 2]; }
print([...numbers()], Object.entries({ a: 1 }), [3, 1].toSorted(), 2n ** 70n);
const sleep = (ms) => new Promise((done) => { const t = script.timer(ms); t.singleShot = true; t.timeout.connect(done); });
async function work() {
    await sleep(5);
    print("slept");
    script.quit();
}
work();
script.run();
//> speed 3 3undefined
//> [1, 2][[a, 1]][1, 3]1180591620717411303424
//> slept
