// SPDX-License-Identifier: BSD-3-Clause
// Reads MCAP files with the reference libraries: every message is decoded by the schema of its own channel.
import { readFileSync } from "node:fs";

import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { loadDecompressHandlers } from "@mcap/support";

import { decoderOf } from "./decoder.mjs";

/** Bytes in memory, as @mcap/core wants to read them. */
class Memory {
  constructor(bytes) {
    this.bytes = bytes;
  }
  async size() {
    return BigInt(this.bytes.byteLength);
  }
  async read(offset, size) {
    return this.bytes.subarray(Number(offset), Number(offset + size));
  }
}

/** All messages of a file by topic: [{time, message}], and its channels, attachments and metadata. */
export async function readIndexed(path) {
  const handlers = await loadDecompressHandlers();
  const reader = await McapIndexedReader.Initialize({
    readable: new Memory(readFileSync(path)),
    decompressHandlers: handlers,
  });
  const decoders = new Map();
  const topics = new Map();
  for (const channel of reader.channelsById.values()) {
    if (topics.has(channel.topic)) throw new Error(`${path}: two channels have the topic ${channel.topic}`);
    topics.set(channel.topic, { channel, schema: reader.schemasById.get(channel.schemaId), messages: [] });
  }
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const topic = topics.get(channel.topic);
    let decoded = message.data;
    if (channel.schemaId !== 0) {
      if (!decoders.has(channel.schemaId)) decoders.set(channel.schemaId, decoderOf(topic.schema));
      decoded = decoders.get(channel.schemaId)(message.data);
    }
    topic.messages.push({ time: message.logTime, sequence: message.sequence, message: decoded });
  }
  const attachments = [];
  for await (const attachment of reader.readAttachments()) attachments.push(attachment);
  const metadata = [];
  for await (const entry of reader.readMetadata()) metadata.push(entry);
  return { topics, attachments, metadata, header: reader.header, statistics: reader.statistics };
}

/** Counts the messages of a file, or of a part of it, record by record, with all checksums checked. */
export async function countStream(bytes) {
  const reader = new McapStreamReader({ decompressHandlers: await loadDecompressHandlers(), validateCrcs: true });
  let messages = 0;
  reader.append(bytes);
  for (let record; (record = reader.nextRecord()); ) if (record.type === "Message") ++messages;
  return messages;
}
