"use strict";
// Reads a file with MCAP's own reader, once by its index and once from its beginning, and prints what is in it as JSON.
// Usage: node read_mcap.js FILE

const fs = require("node:fs");
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const fzstd = require("fzstd");
const { decoderOf } = require("./foxglove_messages.js");

const decompressHandlers = { zstd: (bytes, size) => fzstd.decompress(bytes, new Uint8Array(Number(size))) };

function readable(file) {
  const bytes = fs.readFileSync(file);
  return {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + length))),
  };
}

function countFromTheBeginning(file) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  const bytes = fs.readFileSync(file);
  let messages = 0;
  for (let at = 0; at < bytes.length; at += 65536) {
    reader.append(new Uint8Array(bytes.subarray(at, at + 65536)));
    for (let record = reader.nextRecord(); record; record = reader.nextRecord()) {
      if (record.type === "Message") ++messages;
    }
  }
  if (!reader.done()) throw new Error("the file does not end as MCAP's reader expects");
  return messages;
}

async function main(file) {
  const reader = await McapIndexedReader.Initialize({ readable: readable(file), decompressHandlers });
  const decoders = new Map();
  for (const schema of reader.schemasById.values()) {
    if (schema.encoding !== "protobuf") throw new Error(`schema ${schema.name} is encoded as ${schema.encoding}`);
    decoders.set(schema.id, decoderOf(schema.name, schema.data));
  }
  const messages = [];
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    messages.push({
      topic: channel.topic,
      schema: schema.name,
      log_us: Number(message.logTime / 1000n),
      publish_us: Number(message.publishTime / 1000n),
      content: decoders.get(schema.id)(message.data),
    });
  }
  const counted = Number(reader.statistics.messageCount);
  const streamed = countFromTheBeginning(file);
  if (counted !== messages.length || streamed !== messages.length)
    throw new Error(`${messages.length} messages by the index, ${streamed} from the beginning, ${counted} in the statistics`);
  const { library } = reader.header;
  process.stdout.write(JSON.stringify({ library, chunks: reader.chunkIndexes.length, messages }));
}

main(process.argv[2]).catch((error) => {
  console.error(error.stack);
  process.exit(1);
});
