// What clients cost: bench_clients.mjs BIN SCENES [BODIES...]. Not a test: timings are no claims. BODIES 0: the paper's scene. Clients are
// sockets that take what comes (or, stopped, nothing) and decode nothing.
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { Client, foxglove } from './client.mjs';
import { cpu, manyBodies, memory, Programs, sleep } from './programs.mjs';

const kSeconds = 5;
const [bin, scenes, ...counts] = process.argv.slice(2);

async function stepTime(programs) {
  const values = [];
  for (let i = 0; i < 8; ++i) {
    values.push((await programs.control('watch', 'metrics', '-n', '1')).step_ns);
    await sleep(250);
  }
  return values.sort((a, b) => a - b)[4] / 1000;
}

async function row(programs, gate, server, clients, topics, isStopped) {
  const all = [];
  for (let i = 0; i < clients; ++i) all.push(await new Client(gate.url).ready());
  for (const one of all) {
    for (const topic of topics) one.subscribe(topic, false);
    one.client.on('message', () => { for (const topic of topics) one.messages.set(topic, one.of(topic).slice(-1)); }); // keeps no history
    one.frames = 0;
    one.socket.on('message', () => { ++one.frames; });
  }
  await sleep(2000);
  if (isStopped) for (const one of all) one.socket.pause();
  await sleep(500);
  const sum = (of) => all.reduce((total, one) => total + of(one), 0), start = performance.now();
  const before = { cpu: cpu(gate.pid), server: cpu(server.pid), bytes: sum((c) => c.bytes), frames: sum((c) => c.frames) };
  const step = await stepTime(programs);
  await sleep(1000 * kSeconds - 2000);
  const seconds = (performance.now() - start) / 1000, share = (now, then) => ((100 * (now - then)) / seconds).toFixed(1);
  const each = (now, then, digits) => (clients === 0 ? '-' : ((now - then) / seconds / clients).toFixed(digits));
  console.log([`${clients}${isStopped ? ', stopped' : ''}`.padEnd(12), topics.join(' ').padEnd(22), step.toFixed(1).padStart(9), each(sum((c) => c.frames), before.frames, 0).padStart(11),
    each(sum((c) => c.bytes) / 1e6, before.bytes / 1e6, 3).padStart(9), share(cpu(gate.pid), before.cpu).padStart(8), share(cpu(server.pid), before.server).padStart(8), memory(gate.pid).toFixed(0).padStart(7)].join(' '));
  for (const one of all) one.close();
  await sleep(500);
}

for (const count of counts.length > 0 ? counts : ['0', '1000', '10000']) {
  const programs = new Programs(bin);
  try {
    const scene = count === '0' ? join(scenes, 'fan_and_balloons.xml') : join(programs.folder, 'many.xml');
    if (count !== '0') writeFileSync(scene, manyBodies(Number(count)));
    const server = await programs.server(scene, '--rate', 'real'), gate = await foxglove(programs);
    await sleep(1500);
    console.log(`${count === '0' ? 'paper' : `${count} bodies, all move`}\nclients      topics                  step, us  messages/s     MB/s  gate, %  server, %  gate, MB`);
    const seen = ['/tf', '/scene', 'plab/metrics'];
    await row(programs, gate, server, 0, [], false);
    await row(programs, gate, server, 1, seen, false);
    await row(programs, gate, server, 1, ['plab/states'], false);
    await row(programs, gate, server, 1, ['plab/updates'], false);
    await row(programs, gate, server, 20, seen, false);
    await row(programs, gate, server, 20, seen, true);
  } finally {
    await programs.end();
  }
}
