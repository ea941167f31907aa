// Compares idl/ros, and what Cyclone writes by it, with Foxglove's libraries and the definitions of ROS: compare.mjs ROS_SAMPLES IDL
// [PLABD SCENE DOMAIN]: with a server, what it publishes.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { readFileSync, readdirSync } from 'node:fs';
import { parseIDL } from '@foxglove/omgidl-parser';
import { MessageReader, MessageWriter } from '@foxglove/rosmsg2-serialization';
import { definitions, typeHash, whole } from './definitions.mjs';

const [samples, idlFolder, plabd, scene, domain] = process.argv.slice(2);

// package::msg::dds_::Type_ -> package/Type
const rosName = (type) => type.replace(/::(msg|srv)::dds_::/, '/').replace(/_$/, '');
const isService = (name) => /_(Request|Response)$/.test(name);
const kHeader = [
  { name: 'client', type: 'uint64' },
  { name: 'sequence_number', type: 'int64' },
];
// What goes over the wire: requests and responses have rmw_cyclonedds_cpp's header.
function wireDefinition(name) {
  const [root, ...others] = whole(name);
  return isService(name) ? [{ ...root, definitions: [...kHeader, ...root.definitions] }, ...others] : [root, ...others];
}

function run(args, input) {
  const done = spawnSync(samples, args, { input, encoding: 'utf8', maxBuffer: 1 << 28 });
  assert.equal(done.status, 0, done.stderr);
  return done.stdout.trimEnd().split('\n');
}

// ---- The IDL states what the definitions state: names, types and order of members.

function compareTypes() {
  const files = readdirSync(idlFolder).filter((file) => file.endsWith('.idl'));
  const text = files.map((file) => readFileSync(`${idlFolder}/${file}`, 'utf8').replace(/^#.*$/gm, '')).join('\n');
  const kBuiltin = { time: 'builtin_interfaces/Time', duration: 'builtin_interfaces/Duration' };
  const plain = ({ name, type, isArray, arrayLength, arrayLengths, upperBound }) =>
    `${name}: ${kBuiltin[type] ?? type}${upperBound ?? ''}${isArray ? '[]' : ''}${arrayLengths?.[0] ?? arrayLength ?? ''}`;
  let count = 0;
  for (const struct of parseIDL(text)) {
    if (struct.aggregatedKind !== 'struct') continue;
    const name = rosName(struct.name);
    assert.ok(definitions.has(name), `ROS has no ${name}`);
    const ours = struct.definitions.map((member) => plain({ ...member, isArray: member.isArray || member.arrayLengths, type: member.isComplex ? rosName(member.type) : member.type }));
    const theirs = [...(isService(name) ? kHeader : []), ...definitions.get(name)].map(plain);
    assert.deepEqual(ours, theirs, name);
    ++count;
  }
  return count;
}

// ---- Bytes.

const kIntegers = { int8: [1, true], uint8: [1], int16: [2, true], uint16: [2], int32: [4, true], uint32: [4], int64: [8, true], uint64: [8] };
let seed = 12345;
const random = (n) => {
  seed = (Math.imul(seed, 1103515245) + 12345) >>> 0;
  return (seed >>> 8) % n;
};

function randomPrimitive({ type, upperBound }) {
  if (type === 'string') return 'x'.repeat(random(Math.min(upperBound ?? 20, 20))); // Foxglove's writer counts characters, not bytes
  if (type === 'bool') return random(2) === 1;
  if (type === 'float32') return Math.fround((random(20001) - 10000) / 7);
  if (type === 'float64') return (random(20001) - 10000) / 7;
  if (type === 'time' || type === 'duration') return { sec: random(1 << 20), nanosec: random(1000000000) };
  const [bytes, isSigned] = kIntegers[type];
  if (bytes === 8) return BigInt(random(1 << 20)) * 1000003n * (isSigned && random(2) ? -1n : 1n);
  const value = random(bytes === 1 ? 256 : 65536);
  return isSigned && random(2) ? -(value >> 1) : bytes === 1 && isSigned ? value >> 1 : value;
}

function randomMessage(all, name) {
  const out = {};
  for (const member of all.find((definition) => definition.name === name).definitions) {
    const one = () => (member.isComplex ? randomMessage(all, member.type) : randomPrimitive(member));
    if (!member.isArray) out[member.name] = one();
    else out[member.name] = Array.from({ length: member.arrayLength ?? random(4) }, one);
  }
  return out;
}

// Numbers of typed arrays and of arrays alike.
const comparable = (value) =>
  ArrayBuffer.isView(value) ? Array.from(value, comparable)
  : Array.isArray(value) ? value.map(comparable)
  : value !== null && typeof value === 'object' ? Object.fromEntries(Object.entries(value).map(([key, item]) => [key === 'nsec' ? 'nanosec' : key, comparable(item)]))
  : value;

// Without the four bytes in front, whose last two are options, and what fills the last four.
const body = (bytes, length) => Buffer.from(bytes).subarray(4, length).toString('hex');

function compareBytes(names) {
  const kEach = 40;
  const cases = [];
  for (const type of names)
    for (let i = 0; i < kEach; ++i) {
      const name = rosName(type), all = wireDefinition(name);
      const message = randomMessage(all, name);
      cases.push({ type, all, message, bytes: new MessageWriter(all).writeMessage(message) });
    }
  const lines = run(['echo'], cases.map(({ type, bytes }) => `${type} ${Buffer.from(bytes).toString('hex')}`).join('\n') + '\n');
  assert.equal(lines.length, cases.length);
  cases.forEach(({ type, all, message, bytes }, i) => {
    assert.match(lines[i], /^[0-9a-f]+$/, `${type}: ${lines[i]}`);
    const ours = Buffer.from(lines[i], 'hex');
    assert.equal(body(ours, bytes.length), body(bytes), type);
    assert.deepEqual(comparable(new MessageReader(all).readMessage(ours)), comparable(message), type);
  });
  return cases.length;
}

// ---- Type hashes: the algorithm against published values, the table against the algorithm.

function compareHashes(types) {
  const kPublished = {
    'std_msgs/String': 'RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18',
    'rosgraph_msgs/Clock': 'RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564',
    'sensor_msgs/Range': 'RIHS01_b42b62562e93cbfe9d42b82fe5994dfa3d63d7d5c90a317981703f7388adff3a',
  };
  for (const [name, hash] of Object.entries(kPublished)) assert.equal(typeHash(name), hash, name);
  for (const [type, hash] of types) assert.equal(hash, typeHash(rosName(type)), type);
  return types.length;
}

// ---- What a server publishes.

async function listen() {
  const server = spawn(plabd, [scene, '--ros', '--domain', domain, '--name', `ros_compare_${process.pid}`, '--until', '4', '--rate', 'real'], { stdio: 'ignore' });
  try {
    const lines = run(['listen', domain, '3']);
    return lines.map((line) => {
      const [topic, type, hex] = line.split(' ');
      return { topic, message: new MessageReader(whole(rosName(type))).readMessage(Buffer.from(hex, 'hex')) };
    });
  } finally {
    server.kill();
  }
}

const seconds = ({ sec, nanosec, nsec }) => sec + (nanosec ?? nsec) * 1e-9;
const near = (a, b, tolerance, what) => assert.ok(Math.abs(a - b) <= tolerance, `${what}: ${a}, not ${b}`);

async function compareTopics() {
  const heard = await listen();
  const of = (topic) => heard.filter((entry) => entry.topic === topic).map((entry) => entry.message);
  const clocks = of('clock').map(({ clock }) => seconds(clock));
  assert.ok(clocks.length > 60, `${clocks.length} messages on clock`);
  clocks.forEach((time, i) => assert.ok(i === 0 || time >= clocks[i - 1], 'clock goes back'));
  // scene.xml: a ball that falls from 100 m, a hinge that turns at 2 rad/s, and a shaft at 3 rad/s.
  let falls = 0;
  for (const { transforms } of of('tf'))
    for (const { header, child_frame_id, transform } of transforms) {
      if (child_frame_id !== 'ball') continue;
      const t = seconds(header.stamp);
      near(transform.translation.z, 100 - 0.5 * 9.81 * t * t, 1e-6, `height at ${t} s`);
      assert.equal(header.frame_id, 'world');
      ++falls;
    }
  assert.ok(falls > 60, `${falls} transforms of the ball`);
  for (const { header, name, position, velocity } of of('joint_states')) {
    const t = seconds(header.stamp);
    near(position[name.indexOf('pivot')], 2 * t, 1e-6, 'angle of the hinge');
    near(velocity[name.indexOf('pivot')], 2, 1e-9, 'rate of the hinge');
    near(position[name.indexOf('rotor')], 3 * t, 1e-8, 'angle of the shaft');
  }
  const fixed = of('tf_static').at(-1).transforms.map(({ child_frame_id }) => child_frame_id);
  assert.deepEqual(fixed, ['ground']);
  const markers = of('visualization_marker_array').at(-1).markers;
  assert.equal(markers[0].action, 3);
  const ball = markers.find(({ ns }) => ns === 'ball');
  assert.deepEqual([ball.type, ball.scale.x, ball.frame_locked, ball.header.frame_id], [2, 0.5, true, 'ball']);
  return heard.length;
}

const types = run(['types']).map((line) => line.split(' '));
console.log(`${compareTypes()} structs of idl/ros are those of ROS`);
console.log(`${compareBytes(types.map(([type]) => type))} random messages of ${types.length} types have the same bytes`);
console.log(`${compareHashes(types)} type hashes are those of their definitions`);
if (plabd) console.log(`${await compareTopics()} messages of a server are as its scene has it`);
