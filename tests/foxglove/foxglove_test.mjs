// plab-foxglove against Foxglove's own client: foxglove_test.mjs BIN SCENES
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import WebSocket from 'ws';
import { Client, foxglove } from './client.mjs';
import { Programs, sleep, until } from './programs.mjs';

const [bin, scenes] = process.argv.slice(2);
const programs = new Programs(bin), scene = join(scenes, 'fan_and_balloons.xml');
let server, gate, client;

const open = async (options, gateway = gate) => new Client(gateway.url, options).ready(gateway === gate);
const near = (a, b, what) => assert.ok(Math.abs(a - b) <= 1e-12 * (1 + Math.abs(b)), `${what}: ${a}, not ${b}`);
// As JSON has it: lists for arrays of numbers, numbers for whole ones of 64 bits.
function plain(value) {
  if (typeof value === 'bigint') return Number(value);
  if (Array.isArray(value) || ArrayBuffer.isView(value)) return [...value].map(plain);
  return value !== null && typeof value === 'object' ? Object.fromEntries(Object.entries(value).map(([name, one]) => [name, plain(one)])) : value;
}
const sampleOf = async (topic) => (await programs.control('topics', 'print', topic, '-n', '1', '--full')).sample;
const parameter = (of, name) => of.parameters.flatMap((p) => p.parameters).filter((p) => p.name === name).at(-1);

before(async () => {
  server = await programs.server(scene, '--rate', 'real');
  gate = await foxglove(programs);
  client = await open();
});
after(() => programs.end());

test('it says what it offers, under both names of the protocol', async () => {
  for (const name of ['foxglove.websocket.v1', 'foxglove.sdk.v1']) {
    const one = await open({ name });
    assert.equal(one.socket.protocol, name);
    assert.deepEqual(one.info.capabilities, ['time', 'parameters', 'parametersSubscribe', 'services']);
    assert.deepEqual(one.info.supportedEncodings, ['json']);
    for (const topic of ['/scene', '/tf', 'plab/states', 'plab/objects', 'plab/events', 'plab/metrics', 'plab/gone'])
      assert.equal(one.channels.get(topic).encoding, 'cdr');
    for (const channel of one.channels.values()) assert.equal(channel.schemaEncoding, 'omgidl');
    assert.equal(JSON.parse(one.services.get('plab/swap').request.schema).required.join(), 'component,type');
    one.close();
  }
  const other = new Client(gate.url, { name: 'foxglove.websocket.v0' });
  await until('a client of no known protocol is refused', () => other.error || other.closed);
  assert.equal(other.info, undefined);
});

test('every channel decodes by the schema that was served', async () => {
  const one = await open();
  for (const topic of one.channels.keys()) one.subscribe(topic);
  await until('all that flows has come', () => ['/scene', '/tf', 'plab/server', 'plab/scene', 'plab/objects', 'plab/shapes', 'plab/interactions', 'plab/types', 'plab/states', 'plab/updates', 'plab/metrics', 'plab/hashes', 'plab/snapshots'].every((t) => one.of(t).length > 0));
  await one.call('push', { object: 'green', impulse: [-0.02, 0, 0] });
  await until('requests, replies, the journal and events are there too', () => ['plab/requests', 'plab/replies', 'plab/journal', 'plab/events'].every((t) => one.of(t).length > 0));
  assert.equal(one.error, undefined);
  one.close();
});

test('values are those that plabctl prints', async () => {
  await client.call('pause');
  client.subscribe('plab/states');
  client.subscribe('plab/updates');
  client.subscribe('/tf');
  for (const topic of ['plab/objects', 'plab/interactions', 'plab/shapes', 'plab/types']) client.subscribe(topic);
  await until('states of the paused server come', () => client.last('plab/states') && client.last('/tf') && client.of('plab/types').length > 80);
  await sleep(300);
  const said = await programs.control('watch', 'states', '-n', '1');
  const objects = new Map(client.of('plab/objects').map(({ value }) => [value.component_id, value]));
  const frame = client.last('plab/states'), update = client.last('plab/updates');
  assert.equal(frame.bodies.length, 2);
  for (const [id, body] of Object.entries(said.bodies)) {
    const ours = frame.bodies.find((b) => b.handle === objects.get(id).handle);
    ['x', 'y', 'z'].forEach((axis, i) => {
      assert.equal(ours.position[axis], body.position[i]);
      assert.equal(ours.linear_velocity[axis], body.linear_velocity[i]);
    });
    const row = [...update.body_handles].indexOf(ours.handle);
    assert.equal(update.bodies[13 * row], ours.position.x);
    const moved = client.last('/tf').transforms.find((t) => t.child_frame_id === id);
    assert.equal(moved.parent_frame_id, 'world');
    ['x', 'y', 'z'].forEach((axis) => assert.equal(moved.translation[axis], ours.position[axis]));
    ['w', 'x', 'y', 'z'].forEach((axis) => assert.equal(moved.rotation[axis], ours.orientation[axis]));
  }
  // A shaft turns about the z of its axle.
  const fan = objects.get('fan'), angle = frame.shafts.find((s) => s.handle === fan.handle).angle, q = fan.orientation;
  const turned = client.last('/tf').transforms.find((t) => t.child_frame_id === 'fan').rotation, c = Math.cos(angle / 2), s = Math.sin(angle / 2);
  near(turned.w, q.w * c - q.z * s, 'w of the fan');
  near(turned.z, q.w * s + q.z * c, 'z of the fan');
  // Catalogue, sample by sample, and a log with time.
  for (const [topic, key] of [['plab/scene', 'server_name'], ['plab/objects', 'component_id'], ['plab/types', 'type_name']]) {
    if (!client.messages.has(topic)) client.subscribe(topic);
    await until(`${topic} comes`, () => client.of(topic).length > 0);
    const sample = await sampleOf(topic), ours = client.of(topic).find(({ value }) => value[key] === sample[key]);
    assert.deepEqual(plain(ours.value), sample);
  }
  assert.equal(client.of('plab/states').at(-1).time, BigInt(Math.round(frame.time * 1e9)));
  await until('the simulated time is told', () => client.times.at(-1) === BigInt(Math.round(frame.time * 1e9)));
});

test('the scene has exact shapes in the colours of the objects, and is sent anew only when it changes', async () => {
  const one = await open();
  one.subscribe('/scene');
  await until('the scene comes', () => one.of('/scene').length > 0);
  const { deletions, entities } = one.last('/scene');
  assert.deepEqual(deletions.map((d) => d.type), [1]); // ALL
  assert.equal(entities.length, 8);
  const of = (id) => entities.find((e) => e.id === id);
  assert.equal(of('red').frame_id, 'red');
  assert.equal(of('red').frame_locked, true);
  assert.deepEqual(plain(of('red').spheres), [{ pose: { position: { x: 0, y: 0, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } }, size: { x: 0.3, y: 0.3, z: 0.3 }, color: { r: 0.9, g: 0.1, b: 0.1, a: 1 } }]);
  assert.deepEqual(plain(of('motor').cylinders[0].size), { x: 0.22, y: 0.22, z: 0.3 });
  const gear = of('small_gear').triangles[0];
  assert.ok(gear.points.length > 60 && gear.indices.length % 3 === 0 && Math.max(...gear.indices) < gear.points.length);
  await one.call('resume');
  await sleep(500);
  assert.equal(one.of('/scene').length, 1, 'what only moves is not sent anew');
  const added = await one.call('add', { blueprint: "<component id='post' type='State/Static' shape='balloon' position='0 5 0'/>" });
  assert.equal(added.failure, undefined);
  await until('the new object comes', () => one.last('/scene').entities.some((e) => e.id === 'post'));
  assert.deepEqual(one.last('/scene').entities.map((e) => [e.id, e.frame_id]), [['post', 'world']]);
  assert.equal(one.last('/scene').entities[0].spheres[0].pose.position.y, 5);
  one.subscribe('plab/gone');
  await sleep(200);
  await one.call('remove', { component: 'post' });
  await until('the object goes', () => one.last('/scene').deletions.some((d) => d.id === 'post'));
  one.close();
});

test('an exchange by a service has its proof, and what is refused says why', async () => {
  const { encoding, reply } = await client.call('swap', { component: 'gears', type: 'Constraint/AngularVelocity/Assign' });
  assert.equal(encoding, 'json');
  assert.equal(reply.outcome, 'done');
  assert.equal(reply.swaps[0].to, 'Constraint/AngularVelocity/Assign');
  assert.equal((await programs.control('show', 'gears')).type, 'Constraint/AngularVelocity/Assign');
  assert.match((await client.call('swap', { component: 'gears', type: 'Field/Gravity' })).failure, /^refused: .*family/);
  assert.match((await client.call('swap', { component: 'gears' })).failure, /'type' must be given/);
  assert.match((await client.call('swap', 'no JSON')).failure, /no JSON object/);
  assert.equal((await programs.control('show', 'gears')).type, 'Constraint/AngularVelocity/Assign');
  const several = await client.call('request', { operations: [{ verb: 'pause' }, { verb: 'swap', target: 'gears', argument: 'Constraint/AngularVelocity/Graph' }] });
  assert.equal(several.reply.outcome, 'done');
  const { step } = several.reply;
  assert.equal((await client.call('step', { steps: 10 })).reply.outcome, 'done');
  await until('ten steps are made', async () => (await sampleOf('plab/server')).step === step + 10);
  await client.call('resume');
});

test('parameters are read, set and watched', async () => {
  const one = await open();
  one.client.getParameters(['gears.velocity_factor', 'contact.response.restitution', 'red.position', 'red.no_such'], 'first');
  await until('parameters come', () => one.parameters.some((p) => p.id === 'first'));
  assert.deepEqual(one.parameters[0].parameters.map((p) => p.name), ['gears.velocity_factor', 'contact.response.restitution', 'red.position']);
  assert.deepEqual(parameter(one, 'gears.velocity_factor'), { name: 'gears.velocity_factor', value: -0.5, type: 'float64' });
  assert.equal(parameter(one, 'red.position').type, 'float64_array');
  one.client.getParameters([], 'all');
  await until('all parameters come', () => one.parameters.some((p) => p.id === 'all'));
  assert.ok(one.parameters.at(-1).parameters.length > 20);
  client.client.subscribeParameterUpdates(['gears.velocity_factor']);
  await sleep(200);
  one.client.setParameters([{ name: 'gears.velocity_factor', value: -0.25 }], 'set');
  await until('it is set', () => one.parameters.some((p) => p.id === 'set'));
  assert.equal(parameter(one, 'gears.velocity_factor').value, -0.25);
  await until('the other client hears of it', () => parameter(client, 'gears.velocity_factor')?.value === -0.25);
  const told = (await programs.control('show', 'gears')).parameters.velocity_factor;
  assert.equal(Number(told.text), -0.25);
  // A transaction: the second value is wrong, so the first is not set either.
  one.client.setParameters([{ name: 'gears.velocity_factor', value: -1 }, { name: 'axle_to_gear.velocity_factor', value: 0 }], 'wrong');
  await until('it is refused', () => one.parameters.some((p) => p.id === 'wrong'));
  assert.match(one.statuses.at(-1).message, /were not set: refused/);
  assert.equal(parameter(one, 'gears.velocity_factor').value, -0.25);
  one.close();
});

test('what is malformed is told so, and does no harm', async () => {
  const one = await open();
  const messages = ['', '[]', '{"op":7}', '{"op":"advertise","channels":[]}', '{"op":"subscribe","subscriptions":[{"id":1,"channelId":999}]}', Buffer.from([9]), Buffer.from([2, 1, 0]), Buffer.from([3, 0]), Buffer.alloc(0)];
  for (const message of messages) one.socket.send(message);
  await until('each is answered', () => one.statuses.length === messages.length);
  assert.ok(one.statuses.every((s) => s.level === 2));
  const id = one.subscribe('plab/server');
  one.client.unsubscribe(id + 1); // there is none
  await until('it is served as before', () => one.of('plab/server').length > 0);
  for (let i = 0; i < 70; ++i) one.socket.send(JSON.stringify({ op: 'subscribe', subscriptions: [{ id: 1000 + i, channelId: 1 }] }));
  await until('too many subscriptions are refused', () => one.statuses.some((s) => /may have 64/.test(s.message)));
  const long = await open();
  long.socket.send('x'.repeat((1 << 20) + 1));
  await until('what sends too much is closed', () => long.closed);
  assert.equal(long.closed.code, 1009);
  // A frame that is not masked, which clients must not send; and text that is no UTF-8.
  const raw = await open();
  raw.socket._socket.write(Buffer.from([0x81, 0x02, 0x7b, 0x7d]));
  await until('it is closed or answered', () => raw.closed || raw.statuses.length > 0);
  for (const each of [one, long, raw]) each.close();
  assert.equal(client.closed, undefined);
});

test('a client that takes nothing costs the others nothing, and gets the newest when it goes on', async () => {
  const slow = await open();
  for (const topic of ['/tf', 'plab/states', 'plab/events', '/scene']) slow.subscribe(topic);
  await until('it gets states', () => slow.of('/tf').length > 10);
  slow.socket.pause();
  const before = client.of('/tf').length;
  await sleep(3000);
  const others = client.of('/tf').length - before;
  assert.ok(others > 60, `the other one got ${others} frames in 3 s`);
  slow.socket.resume();
  await until('it gets the newest', () => slow.of('/tf').length > 0 && slow.of('/tf').at(-1).time >= client.of('/tf').at(-1).time - 500_000_000n);
  slow.close();
});

test('pages of other sites, other hosts and one client too many are refused', async () => {
  const status = (options, headers) => new Promise((resolve) => {
    const socket = new WebSocket(gate.url, ['foxglove.websocket.v1'], { ...options, headers });
    socket.on('open', () => { socket.terminate(); resolve(101); });
    socket.on('error', () => resolve(0));
  });
  for (const origin of ['https://app.foxglove.dev', 'https://studio.foxglove.dev', 'http://localhost:8080']) assert.equal(await status({ origin }), 101, origin);
  for (const origin of ['https://evil.example', 'https://app.foxglove.dev.evil.example', 'null']) assert.equal(await status({ origin }), 0, origin);
  assert.equal(await status({}, { Host: 'evil.example' }), 0);
  const all = [];
  for (let i = 0; i < 40; ++i) all.push(new Client(gate.url));
  await until('some are refused', () => all.filter((c) => c.closed).length >= 8);
  await sleep(300);
  assert.equal(all.filter((c) => !c.closed).length, 31); // and the one of all tests
  for (const one of all) one.close();
  await until('there is room again', async () => { const one = new Client(gate.url); await sleep(100); const ok = !!one.info; one.close(); return ok; });
});

test('with a token the address is a secret, and read-only offers no services', async () => {
  const closed = await foxglove(programs, '--token', '--read-only', '--origin', 'https://studio.example');
  assert.match(closed.url, /ws:\/\/127\.0\.0\.1:\d+\/[0-9a-f]{32}\/$/);
  const root = new URL('/', closed.url).href;
  for (const url of [root, `${root}${'0'.repeat(32)}/`]) {
    const one = new Client(url);
    await until('it is refused', () => one.error || one.closed);
    assert.equal(one.info, undefined);
  }
  const one = await open({ origin: 'https://studio.example' }, closed);
  const other = await open({}, { url: closed.url.replace(/\/$/, '') }); // without its last /
  assert.equal(other.services.size, 0);
  one.client.setParameters([{ name: 'gears.velocity_factor', value: -2 }], 'x');
  await until('nothing can be set', () => one.statuses.some((s) => /nothing can be changed/.test(s.message)));
  one.client.sendServiceCallRequest({ serviceId: 1, callId: 1, encoding: 'json', data: new Uint8Array() });
  await until('nothing can be called', () => one.replies.get(1)?.failure);
  closed.kill('SIGINT');
  assert.equal(await closed.ended, 130);
});

test('when the server is killed clients are told, and go on with its successor', async () => {
  const one = await open();
  one.subscribe('/tf');
  one.subscribe('/scene');
  one.subscribe('plab/objects');
  await until('it moves', () => one.of('/tf').length > 5 && one.of('plab/objects').length >= 8);
  server.kill('SIGKILL');
  await until('it is told', () => one.statuses.some((s) => s.id === 'server' && s.level === 1), 30000);
  assert.match((await one.call('pause')).failure, /no server|has gone/);
  const late = await open();
  await until('who comes now is told as well', () => late.statuses.some((s) => s.id === 'server'));
  late.close();
  const [frames, scenesBefore] = [one.of('/tf').length, one.of('/scene').length];
  server = await programs.server(scene, '--rate', 'real');
  await until('it moves again', () => one.of('/tf').length > frames + 10 && one.of('/scene').length > scenesBefore, 30000);
  assert.deepEqual(one.removed, ['server']);
  assert.equal(one.last('/scene').deletions[0].type, 1);
  assert.ok(one.of('/tf').at(-1).time < one.of('/tf')[frames - 1].time, 'time has begun anew');
  one.close();
});

test('a recording is played under control', async () => {
  const file = join(programs.folder, 'run.mcap');
  const recorder = programs.start('plabd', scene, '--no-bus', '--until', '4', '--record', file);
  assert.equal(await recorder.ended, 0);
  const player = await foxglove(programs, '--file', file);
  const one = new Client(player.url, { name: 'foxglove.sdk.v1' });
  await one.ready(false);
  assert.ok(one.info.capabilities.includes('playbackControl') && !one.info.capabilities.includes('services'));
  const ns = ({ sec, nsec }) => BigInt(sec) * 1_000_000_000n + BigInt(nsec), from = ns(one.info.dataStartTime), to = ns(one.info.dataEndTime);
  assert.ok(to - from > 3_900_000_000n && to - from < 4_100_000_000n, `${from} to ${to}`);
  for (const topic of ['/tf', '/scene', 'plab/states']) one.subscribe(topic);
  await until('the scene is there', () => one.of('/scene').length > 0 && one.last('/scene').entities.length === 8);
  await sleep(300);
  const still = one.of('/tf').length;
  await sleep(300);
  assert.ok(one.of('/tf').length - still <= 1, 'it begins paused');
  one.control(true, 1, undefined, 'play');
  assert.deepEqual((({ status, speed, didSeek }) => ({ status, speed, didSeek }))(await one.answered('play')), { status: 0, speed: 1, didSeek: false });
  await until('it plays', () => one.of('/tf').length > still + 20);
  one.control(false, 2, from + 3_000_000_000n, 'seek');
  const sought = await one.answered('seek');
  assert.deepEqual([sought.status, sought.speed, sought.didSeek, sought.time], [1, 2, true, from + 3_000_000_000n]);
  await until('the state of that moment comes', () => Math.abs(one.last('plab/states').time - 3) < 0.02);
  assert.ok(one.of('plab/states').at(-1).time === from + 3_000_000_000n);
  one.control(true, 2, undefined, 'on');
  await until('it comes to its end', () => one.playback.some((p) => p.status === 3 && p.request === ''));
  one.control(true, 1, from + 500_000_000n, 'again');
  assert.equal((await one.answered('again')).status, 0);
  await until('it plays from there', () => { const { time } = one.last('plab/states'); return time > 0.5 && time < 2; });
  assert.ok(one.times.every((t) => t >= from && t <= to));
  // A run that does not play refuses the control of a playback.
  client.control(true, 1, undefined, 'live');
  await until('it is refused', () => client.statuses.some((s) => /no recording/.test(s.message)));
  one.close();
});

test('no decoder had an error', () => assert.equal(client.error, undefined));
