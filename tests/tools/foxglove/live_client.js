"use strict";
// Connects to hs-view with Foxglove's own client, subscribes to every channel, and prints as JSON what has come once each of
// the topics that are wanted has so many messages; then, how the connection was closed.
// Usage: node live_client.js URL COUNT TOPIC...

const { FoxgloveClient } = require("@foxglove/ws-protocol");
const WebSocket = require("ws");
const { decoderOf } = require("./foxglove_messages.js");

const [url, countText, ...wanted] = process.argv.slice(2);
const count = Number(countText);
const socket = new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
const client = new FoxgloveClient({ ws: socket });
const channels = new Map();
const topicOf = new Map();
const decoders = new Map();
const result = { info: null, protocol: "", schemas: {}, messages: {}, closed: null };
let printed = false;

function fail(error) {
  console.error(error.stack || String(error));
  process.exit(1);
}

// Models are sent once, everything else again and again.
function isThere(topic) {
  const got = (result.messages[topic] || []).length;
  return got >= (topic.includes("/objects/") ? 1 : count);
}

client.on("error", fail);
client.on("serverInfo", (info) => {
  result.info = info;
  result.protocol = socket.protocol;
});
client.on("advertise", (advertised) => {
  for (const channel of advertised) {
    if (channels.has(channel.id)) fail(new Error(`channel ${channel.id} is advertised twice`));
    channels.set(channel.id, channel);
    result.schemas[channel.topic] = channel.schemaName;
    if (channel.encoding !== "protobuf" || channel.schemaEncoding !== "protobuf") fail(new Error(JSON.stringify(channel)));
    const subscription = client.subscribe(channel.id);
    topicOf.set(subscription, channel.topic);
    decoders.set(subscription, decoderOf(channel.schemaName, Buffer.from(channel.schema, "base64")));
  }
});
client.on("message", ({ subscriptionId, timestamp, data }) => {
  const topic = topicOf.get(subscriptionId);
  if (!topic) fail(new Error(`a message of subscription ${subscriptionId}, which is none`));
  const content = decoders.get(subscriptionId)(new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
  const list = (result.messages[topic] = result.messages[topic] || []);
  if (list.length < 50) list.push({ received_us: Number(timestamp / 1000n), content });
  if (!printed && wanted.every(isThere)) {
    printed = true;
    process.stdout.write(JSON.stringify(result) + "\n");
  }
});
client.on("close", (event) => {
  process.stdout.write(JSON.stringify({ closed: event.code, reason: event.reason }) + "\n");
  process.exit(0);
});
