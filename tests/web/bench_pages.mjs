// What many pages cost: bench_pages.mjs BIN SCENES [BODIES]. Not a test: timings are no claims. Pages are stood for by sockets that
// acknowledge what they get at once, or (stopped) never; what a browser needs to draw is not in it.
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import WebSocket from 'ws';
import { cpu, Lab, manyBodies, memory, sleep, until } from './lab.mjs';

const kSeconds = 6;
const [bin, , count = '1000'] = process.argv.slice(2);
const lab = new Lab(bin);

function open(url, isStopped, counts) {
  const socket = new WebSocket(`${url.replace('http', 'ws')}socket`, 'plab-web-1', { origin: new URL(url).origin });
  socket.on('message', (data, isBinary) => {
    counts.bytes += data.length;
    if (!isBinary) return;
    ++counts.poses;
    if (!isStopped) socket.send('1');
  });
  return new Promise((resolve) => socket.on('open', () => resolve(socket)));
}

async function stepTime() {
  const values = [];
  for (let i = 0; i < 8; ++i) {
    values.push((await lab.control('watch', 'metrics', '-n', '1')).step_ns);
    await sleep(250);
  }
  return values.sort((a, b) => a - b)[4];
}

try {
  const scene = join(lab.folder, 'many.xml');
  writeFileSync(scene, manyBodies(Number(count)));
  const server = await lab.server(scene, '--rate', 'real');
  const url = await lab.web(), web = lab.webProcess.pid;
  await sleep(1500);
  console.log(`${count} bodies, all move; CPU in % of a core\npages          plab-web  plabd   step, us  frames/s/page  MB/s/page  memory of plab-web, MB`);
  for (const [pages, isStopped] of [[0, false], [1, false], [20, false], [20, true], [0, false]]) {
    const counts = { bytes: 0, poses: 0 }, sockets = [];
    for (let i = 0; i < pages; ++i) sockets.push(await open(url, isStopped, counts));
    await sleep(1500);
    Object.assign(counts, { bytes: 0, poses: 0 });
    const before = [cpu(web), cpu(server.pid), performance.now()];
    const step = await stepTime();
    await sleep(1000 * kSeconds - 2000);
    const seconds = (performance.now() - before[2]) / 1000, share = (now, then) => ((100 * (now - then)) / seconds).toFixed(1);
    const each = (value) => (pages === 0 ? '-' : (value / seconds / pages).toFixed(2));
    console.log([`${pages}${isStopped ? ' stopped' : ''}`.padEnd(14), share(cpu(web), before[0]).padStart(8), share(cpu(server.pid), before[1]).padStart(7),
      (step / 1000).toFixed(1).padStart(10), each(counts.poses).padStart(14), each(counts.bytes / 1e6).padStart(10), memory(web).toFixed(0).padStart(10)].join(' '));
    for (const socket of sockets) socket.terminate();
    await until('the pages are gone', async () => { await sleep(500); return true; });
  }
} finally {
  await lab.end();
}
