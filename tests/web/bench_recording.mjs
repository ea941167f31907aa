// What a recording from the page costs while it is made: bench_recording.mjs BIN SCENES CHROMIUM PICTURES [BODIES]; without BODIES, the
// paper's scene. Not a test: timings are no claims. The page is stood for by a socket that acknowledges what it gets at once.
import { readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import WebSocket from 'ws';
import { Lab, manyBodies, processesUnder, sleep } from './lab.mjs';

const kSeconds = 10, kTicks = 100; // clock ticks of /proc per second
const [bin, scenes, , , count = ''] = process.argv.slice(2);
const lab = new Lab(bin);

function cpu(pid) {
  const words = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ');
  return (Number(words[11]) + Number(words[12])) / kTicks;
}

async function stepTime() {
  const values = [];
  for (let i = 0; i < 20; ++i) {
    values.push((await lab.control('watch', 'metrics', '-n', '1')).step_ns);
    await sleep(250);
  }
  return values.sort((a, b) => a - b)[10] / 1000;
}

try {
  const scene = count ? join(lab.folder, 'many.xml') : join(scenes, 'fan_and_balloons.xml');
  if (count) writeFileSync(scene, manyBodies(Number(count)));
  const server = await lab.server(scene, '--rate', 'real'), folder = join(lab.folder, 'runs');
  const url = await lab.web('--recordings', folder), web = lab.webProcess.pid;
  const socket = new WebSocket(`${url.replace('http', 'ws')}socket`, 'plab-web-1', { origin: new URL(url).origin });
  socket.on('message', (data, isBinary) => isBinary && socket.send('1'));
  await new Promise((resolve) => socket.on('open', resolve));
  await sleep(2000);
  console.log(`${count || 'the paper\'s scene'}; CPU in % of a core, over ${kSeconds} s\nrecording  plab-web  plabd and plab-bus  recorder  step, us  MB/s of the file`);
  for (const isOn of [false, true]) {
    if (isOn) socket.send(JSON.stringify({ type: 'job', id: 1, verb: 'record', name: 'bench' }));
    await sleep(2000);
    const servers = [server.pid, ...processesUnder(server.pid).map((one) => one.pid)];
    const recorder = processesUnder(web).find((one) => one.command.includes(' record '))?.pid;
    const size = () => (isOn ? statSync(join(folder, 'bench.mcap')).size : 0);
    const all = () => [cpu(web), servers.reduce((sum, pid) => sum + cpu(pid), 0), recorder ? cpu(recorder) : 0, size() / 1e6];
    const before = all(), begin = performance.now();
    await sleep(1000 * kSeconds);
    const seconds = (performance.now() - begin) / 1000, now = all();
    const [page, servers_, recording, bytes] = now.map((value, i) => (100 * (value - before[i])) / seconds);
    const step = await stepTime();
    console.log([(isOn ? 'on' : 'off').padEnd(9), page.toFixed(1).padStart(9), servers_.toFixed(1).padStart(19), recording.toFixed(1).padStart(9), step.toFixed(1).padStart(9), (bytes / 100).toFixed(3).padStart(10)].join(' '));
  }
  socket.terminate();
} finally {
  await lab.end();
}
