// A client of plab-foxglove that collects what it gets: Foxglove's own one, and its decoders with the schemas that were served.
import { parseIDL } from '@foxglove/omgidl-parser';
import { MessageReader } from '@foxglove/omgidl-serialization';
import protocol from '@foxglove/ws-protocol';
import WebSocket from 'ws';
import { until } from './programs.mjs';

const { FoxgloveClient } = protocol;
const utf8 = new TextEncoder(), text = new TextDecoder();

export class Client {
  constructor(url, { name = 'foxglove.websocket.v1', origin } = {}) {
    this.socket = new WebSocket(url, [name], origin === undefined ? {} : { origin });
    this.channels = new Map();
    this.services = new Map();
    this.messages = new Map(); // topic: decoded, with their times
    this.statuses = [];
    this.removed = [];
    this.parameters = [];
    this.replies = new Map();
    this.bytes = 0;
    this.times = [];
    this.playback = [];
    this.subscriptions = new Map();
    this.calls = 0;
    // Of foxglove.sdk.v1 alone: the client of the older name does not know it.
    this.socket.on('message', (received, isBinary) => {
      const data = Buffer.from(received);
      this.bytes += data.length;
      if (isBinary && data[0] === 5)
        this.playback.push({ status: data[1], time: data.readBigUInt64LE(2), speed: data.readFloatLE(10), didSeek: data[14] === 1, request: data.toString('utf8', 19, 19 + data.readUInt32LE(15)) });
    });
    const client = new FoxgloveClient({ ws: this.socket });
    this.client = client;
    client.on('error', (error) => { if (!/opcode in binary message: 5/.test(error.message)) this.error = error; });
    client.on('close', (event) => { this.closed = { code: event.code, reason: event.reason }; });
    client.on('serverInfo', (info) => { this.info = info; });
    client.on('advertise', (channels) => channels.forEach((c) => this.channels.set(c.topic, c)));
    client.on('advertiseServices', (services) => services.forEach((s) => this.services.set(s.name, s)));
    client.on('status', (status) => this.statuses.push(status));
    client.on('removeStatus', ({ statusIds }) => this.removed.push(...statusIds));
    client.on('time', ({ timestamp }) => this.times.push(timestamp));
    client.on('parameterValues', (values) => this.parameters.push(values));
    client.on('serviceCallResponse', (r) => this.replies.set(r.callId, { encoding: r.encoding, reply: JSON.parse(text.decode(r.data)) }));
    client.on('serviceCallFailure', (failure) => this.replies.set(failure.callId, { failure: failure.message }));
    client.on('message', (message) => {
      const { topic, reader } = this.subscriptions.get(message.subscriptionId) ?? {};
      if (topic === undefined) return; // subscribed without subscribe()
      this.messages.get(topic).push({ time: message.timestamp, bytes: message.data.byteLength, value: reader?.readMessage(message.data) });
    });
  }

  async ready(services = true) {
    await until('a client is greeted', () => this.closed || (this.info && this.channels.size > 0 && (this.services.size > 0 || !services)));
    if (this.closed) throw new Error(`closed: ${this.closed.code} ${this.closed.reason}`);
    return this;
  }

  // Not decoded: their number and size are counted alone.
  subscribe(topic, decode = true) {
    const channel = this.channels.get(topic);
    this.messages.set(topic, this.messages.get(topic) ?? []);
    const reader = decode ? new MessageReader(channel.schemaName, parseIDL(channel.schema)) : undefined;
    const id = this.client.subscribe(channel.id);
    this.subscriptions.set(id, { topic, reader });
    return id;
  }

  of(topic) { return this.messages.get(topic) ?? []; }
  last(topic) { return this.of(topic).at(-1)?.value; }

  async call(name, data) {
    const callId = ++this.calls, service = this.services.get(`plab/${name}`);
    this.client.sendServiceCallRequest({ serviceId: service.id, callId, encoding: 'json', data: utf8.encode(typeof data === 'string' ? data : JSON.stringify(data ?? {})) });
    await until(`${name} is answered`, () => this.replies.has(callId));
    return this.replies.get(callId);
  }

  control(plays, speed, seek, request) {
    const id = utf8.encode(request), bytes = Buffer.alloc(19 + id.length);
    bytes[0] = 3;
    bytes[1] = plays ? 0 : 1;
    bytes.writeFloatLE(speed, 2);
    bytes[6] = seek === undefined ? 0 : 1;
    bytes.writeBigUInt64LE(BigInt(seek ?? 0), 7);
    bytes.writeUInt32LE(id.length, 15);
    bytes.set(id, 19);
    this.socket.send(bytes);
  }

  async answered(request) {
    await until(`the control ${request} is answered`, () => this.playback.some((p) => p.request === request));
    return this.playback.find((p) => p.request === request);
  }

  close() { this.socket.terminate(); }
}

export async function foxglove(programs, ...args) {
  const child = programs.start('plab-foxglove', '--port', '0', ...args);
  await until('plab-foxglove prints its address', () => /ws:\/\/\S+/.test(child.text));
  child.url = child.text.match(/ws:\/\/\S+/)[0];
  return child;
}
