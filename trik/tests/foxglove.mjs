// A client of Foxglove's own libraries, for tests: prints a line of JSON for each thing that happens, and asks what lines of
// its input say. Its argument is the address; TRIK_MCAP_NODE names the folder with the libraries.
import { createRequire } from "node:module";
import { createInterface } from "node:readline";

const load = createRequire(process.env.TRIK_MCAP_NODE + "/");
const { FoxgloveClient } = load("@foxglove/ws-protocol");
const { parse } = load("@foxglove/rosmsg");
const { MessageReader } = load("@foxglove/rosmsg2-serialization");
const WebSocket = load("ws");

const tell = (what, more) =>
  console.log(JSON.stringify({ what, ...more }, (_, value) => (typeof value === "bigint" ? Number(value) : value)));
const socket = new WebSocket(process.argv[2], [process.argv[3] ?? FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
const client = new FoxgloveClient({ ws: socket });
const channels = new Map();
const readers = new Map();
const wanted = new Set();
const services = new Map();

function subscribe(topic) {
  for (const channel of channels.values()) {
    if (channel.topic === topic) {
      const reader = new MessageReader(parse(channel.schema, { ros2: true }));
      readers.set(client.subscribe(channel.id), { topic, reader });
    }
  }
}

client.on("open", () => tell("open", { protocol: socket.protocol }));
client.on("close", () => tell("close"));
client.on("error", (error) => tell("error", { message: String(error?.message ?? error) }));
client.on("serverInfo", (info) => tell("info", info));
client.on("status", (status) => tell("status", status));
client.on("removeStatus", (status) => tell("removeStatus", status));
client.on("advertise", (all) => {
  for (const channel of all) {
    channels.set(channel.id, channel);
    if (wanted.has(channel.topic)) subscribe(channel.topic);
  }
  tell("channels", { topics: all.map((one) => one.topic), schemas: all.map((one) => one.schemaName) });
});
client.on("unadvertise", (ids) => {
  tell("gone", { topics: ids.map((id) => channels.get(id)?.topic) });
  for (const id of ids) channels.delete(id);
});
client.on("message", ({ subscriptionId, timestamp, data }) => {
  const { topic, reader } = readers.get(subscriptionId);
  tell("message", { topic, seconds: Number(timestamp) / 1e9, value: reader.readMessage(data) });
});
client.on("time", ({ timestamp }) => tell("time", { seconds: Number(timestamp) / 1e9 }));
client.on("parameterValues", (values) => tell("parameters", values));
client.on("advertiseServices", (all) => {
  for (const service of all) services.set(service.name, service);
  tell("services", { names: all.map((one) => one.name) });
});
client.on("serviceCallResponse", ({ callId }) => tell("done", { callId }));
client.on("serviceCallFailure", ({ callId, message }) => tell("failed", { callId, message }));
client.on("connectionGraphUpdate", (graph) => tell("graph", graph));

let calls = 0;
createInterface({ input: process.stdin }).on("line", (line) => {
  const [order, ...words] = line.split(" ");
  if (order === "subscribe") {
    wanted.add(words[0]);
    subscribe(words[0]);
  } else if (order === "get") client.getParameters(words, "asked");
  else if (order === "set") client.setParameters([{ name: words[0], value: JSON.parse(words[1]) }], "told");
  else if (order === "watch") client.subscribeParameterUpdates(words);
  else if (order === "graph") client.subscribeConnectionGraph();
  else if (order === "call") {
    const data = new TextEncoder().encode(JSON.stringify(words[1] ? { file: words[1] } : {}));
    client.sendServiceCallRequest({
      serviceId: services.get(words[0]).id,
      callId: ++calls,
      encoding: "json",
      data: new DataView(data.buffer),
    });
  } else if (order === "bytes") socket.send(Buffer.from(words[0], "hex"));
  else if (order === "text") socket.send(words.join(" "));
}).on("close", () => {
  client.close();
  setTimeout(() => process.exit(0), 200);
});
