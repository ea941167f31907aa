// Reads a recording with @mcap/core and @foxglove/omgidl-*, and compares every message with our own reader's dump.
//
//   node compare.mjs FILE.mcap FILE.jsonl
import { readFile } from "node:fs/promises";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader } from "@foxglove/omgidl-serialization";
import lz4 from "@foxglove/wasm-lz4";
import zstd from "@foxglove/wasm-zstd";

await Promise.all([lz4.isLoaded, zstd.isLoaded]);
const decompressHandlers = {
  lz4: (bytes, size) => lz4(bytes, Number(size)),
  zstd: (bytes, size) => zstd.decompress(bytes, Number(size)),
};

class BufferSource {
  constructor(bytes) { this.bytes = bytes; }
  async size() { return BigInt(this.bytes.length); }
  async read(offset, length) { return new Uint8Array(this.bytes.subarray(Number(offset), Number(offset + length))); }
}

function fail(message) {
  console.error(`compare: ${message}`);
  process.exit(1);
}

// Ours are quoted; "inf" and "-0" are numbers.
function sameNumber(ours, theirs) {
  const number = ours === "inf" ? Infinity : ours === "-inf" ? -Infinity : Number(ours);
  return Object.is(number, theirs);
}

let compared = 0;
function expectSame(ours, theirs, path) {
  if (typeof theirs === "bigint") {
    if (BigInt(ours) !== theirs) fail(`${path}: ${theirs}, not ${ours}`);
  } else if (typeof theirs === "number") {
    if (!sameNumber(ours, theirs)) fail(`${path}: ${theirs}, not ${ours}`);
  } else if (Array.isArray(theirs) || ArrayBuffer.isView(theirs)) {
    if (!Array.isArray(ours) || ours.length !== theirs.length) fail(`${path}: ${theirs.length} elements, not ${ours?.length}`);
    ours.forEach((element, i) => expectSame(element, theirs[i], `${path}[${i}]`));
    return;
  } else if (typeof theirs === "object" && theirs !== null) {
    const names = Object.keys(theirs);
    if (names.join() !== Object.keys(ours).join()) fail(`${path}: members ${names}, not ${Object.keys(ours)}`);
    for (const name of names) expectSame(ours[name], theirs[name], `${path}.${name}`);
    return;
  } else if (ours !== theirs) {
    fail(`${path}: ${theirs}, not ${ours}`);
  }
  compared += 1;
}

const readers = new Map();
function decode(schema, data) {
  if (schema.encoding !== "omgidl") fail(`schema ${schema.name}: encoding ${schema.encoding}`);
  if (!readers.has(schema.name)) {
    readers.set(schema.name, new MessageReader(schema.name, parseIDL(new TextDecoder().decode(schema.data))));
  }
  return readers.get(schema.name).readMessage(data);
}

function compareMessage(line, message, channel, schema) {
  const ours = JSON.parse(line);
  const path = `${ours.topic} at ${ours.log_time}`;
  if (channel.messageEncoding !== "cdr") fail(`${path}: encoding ${channel.messageEncoding}`);
  expectSame([ours.topic, ours.schema], [channel.topic, schema.name], path);
  expectSame([ours.log_time, ours.publish_time], [message.logTime, message.publishTime], path);
  expectSame(ours.sequence, message.sequence, `${path}: sequence`);
  expectSame(ours.value, decode(schema, message.data), path);
}

// As a program that has the whole file: by its index.
async function compareIndexed(bytes, lines) {
  const reader = await McapIndexedReader.Initialize({ readable: new BufferSource(bytes), decompressHandlers });
  let next = 0;
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    if (next >= lines.length) fail("more messages than we read");
    compareMessage(lines[next++], message, channel, reader.schemasById.get(channel.schemaId));
  }
  if (next !== lines.length) fail(`${next} messages, not ${lines.length}`);
  if (reader.statistics.messageCount !== BigInt(lines.length)) fail(`statistics count ${reader.statistics.messageCount} messages`);
  for await (const record of reader.readMetadata()) if (!record.metadata.has("crc32")) fail(`metadata ${record.name} has no seal`);
}

// As a program that gets the file piece by piece; it checks all CRCs.
function countStreamed(bytes) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  const counts = {};
  for (let at = 0; at < bytes.length; at += 10_000) {
    reader.append(bytes.subarray(at, at + 10_000));
    for (let record = reader.nextRecord(); record; record = reader.nextRecord()) counts[record.type] = (counts[record.type] ?? 0) + 1;
  }
  if (!reader.done()) fail("the stream does not end");
  return counts;
}

const [file, dump] = process.argv.slice(2);
const bytes = new Uint8Array(await readFile(file));
const lines = (await readFile(dump, "utf8")).split("\n").filter((line) => line !== "");
if (lines.length === 0) fail("nothing to compare");
await compareIndexed(bytes, lines);
const counts = countStreamed(bytes);
if (counts.Message !== lines.length) fail(`${counts.Message} messages in the stream, not ${lines.length}`);
if (counts.Footer !== 1) fail("no footer in the stream");
console.log(`${lines.length} messages of ${readers.size} types, ${compared} values: the same`);
