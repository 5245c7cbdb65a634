// Reads a recording by @mcap/core and tells what is in it: topics, counts, some last values.

const fs = require("fs/promises");
const { McapIndexedReader } = require("@mcap/core");
const { loadDecompressHandlers } = require("@mcap/support");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader } = require("@foxglove/rosmsg2-serialization");

const FIELDS = {
  "/code": ["data"],
  "/faults": ["name", "msg", "level", "line"],
  "/log": ["name", "msg", "level", "line"],
  "/node/raw": ["data"],
  "/sensors/A1": ["x", "x2", "y", "class"],
};

function value(found) {
  return typeof found === "object" ? Array.from(found).join(",") : String(found);
}

async function main(path) {
  const file = await fs.open(path);
  const readable = {
    size: async () => BigInt((await file.stat()).size),
    read: async (offset, length) => {
      const bytes = new Uint8Array(Number(length));
      await file.read(bytes, 0, Number(length), Number(offset));
      return bytes;
    },
  };
  const decompressHandlers = await loadDecompressHandlers();
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const decoders = new Map();
  const counts = {};
  const last = {};
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    if (!decoders.has(channel.id)) {
      const text = new TextDecoder().decode(reader.schemasById.get(channel.schemaId).data);
      decoders.set(channel.id, new MessageReader(parse(text, { ros2: true })));
    }
    counts[channel.topic] = (counts[channel.topic] ?? 0) + 1;
    last[channel.topic] = decoders.get(channel.id).readMessage(message.data);
  }
  for (const topic of Object.keys(counts).sort()) {
    const values = (FIELDS[topic] ?? []).map((name) => `${name}=${value(last[topic][name])}`);
    console.log([topic, counts[topic], ...values].join(" "));
  }
  await file.close();
}

main(process.argv[2]).catch((error) => {
  console.error(error);
  process.exit(1);
});
