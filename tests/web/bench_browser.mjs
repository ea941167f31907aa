// What the page needs in a browser: bench_browser.mjs BIN SCENES CHROMIUM. Not a test: timings are no claims.
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { Lab, manyBodies, sleep } from './lab.mjs';

const kSeconds = 8, kTicks = 100;
const [bin, scenes, chromium] = process.argv.slice(2);

// s of all processes of the browser, whose profile is in this folder, and its children.
function cpuOfBrowser(root) {
  const parents = new Map();
  for (const pid of readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
    try {
      const words = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ');
      parents.set(Number(pid), { parent: Number(words[1]), cpu: (Number(words[11]) + Number(words[12])) / kTicks });
    } catch { /* it has ended */ }
  }
  const isInside = (pid) => pid === root || (parents.has(pid) && isInside(parents.get(pid).parent));
  return [...parents].filter(([pid]) => isInside(pid)).reduce((sum, [, one]) => sum + one.cpu, 0);
}

console.log('scene             shown after, s  pictures/s  MB/s  browser, % of a core  heap, MB');
for (const bodies of [0, 1000, 10000]) {
  const lab = new Lab(bin);
  try {
    let scene = join(scenes, 'fan_and_balloons.xml');
    if (bodies > 0) {
      scene = join(lab.folder, 'many.xml');
      writeFileSync(scene, manyBodies(bodies));
    }
    await lab.server(scene, '--rate', 'real');
    await lab.web();
    await lab.launch(chromium);
    const begin = performance.now();
    const page = await lab.page(bodies || 8);
    const shown = (performance.now() - begin) / 1000;
    for (const [what, pause] of [['', false], [' paused', true]]) {
      if (pause) await page.evaluate(() => plab.socket.request({ verb: 'pause' }));
      await sleep(pause ? 2000 : 7000); // until it has given up what is too slow
      const measure = () => page.evaluate(() => ({ pictures: plab.view.pictures, bytes: plab.socket.bytes, at: performance.now(), heap: performance.memory.usedJSHeapSize }));
      const before = await measure(), used = cpuOfBrowser(lab.browser.process().pid);
      await sleep(1000 * kSeconds);
      const after = await measure(), seconds = (after.at - before.at) / 1000;
      console.log([`${bodies || 'paper'}${what}`.padEnd(17), shown.toFixed(2).padStart(15), ((after.pictures - before.pictures) / seconds).toFixed(1).padStart(11),
        ((after.bytes - before.bytes) / seconds / 1e6).toFixed(2).padStart(5), ((100 * (cpuOfBrowser(lab.browser.process().pid) - used)) / seconds).toFixed(0).padStart(21), (after.heap / 1e6).toFixed(0).padStart(9)].join(' '));
    }
  } finally {
    await lab.end();
  }
}
