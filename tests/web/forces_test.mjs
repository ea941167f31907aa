// The forces of contacts on the page of plab-web: forces_test.mjs BIN SCENES CHROMIUM PICTURES
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Lab, sleep, until } from './lab.mjs';

const [bin, , chromium, pictures] = process.argv.slice(2);
const kG = 9.81;
const lab = new Lab(bin);
let server, page;

const shot = (of, name) => of.screenshot({ path: join(pictures, `${name}.png`) });
const contactsOf = (of) => of.evaluate(() => plab.model.contacts);
const ask = (of, operation) => of.evaluate((o) => plab.socket.request(o), operation);

// A stack of five boxes of 2 kg, a box that slides on a slope, and a ball of 5 kg; all on the ground or on what stands there.
const kHeaps = `<plab version="1"><scene title="Heaps" dt="1/240"><camera id="front" position="2.6 -4.2 1.6" look_at="0.4 0 0.45"/></scene>
  <component id="floor" type="Shape/Plane"/><component id="ground" type="State/Static" shape="floor"/>
  <component id="cube" type="Shape/Box" half_extents="0.2 0.2 0.1"/><component id="round" type="Shape/Sphere" radius="0.2"/>
  <component id="ramp" type="Shape/Box" half_extents="0.8 0.4 0.05"/>
  <component id="slope" type="State/Static" shape="ramp" position="1.5 0 0.3" orientation="0.968912421710645 0 0.247403959254523 0" color="0.6 0.6 0.65"/>
  ${[0, 1, 2, 3, 4].map((k) => `<component id="b${k}" type="State/RigidBody" shape="cube" mass="2" color="0.85 0.6 0.3" position="0 0 ${0.1 + 0.2 * k}"/>`).join('\n')}
  <component id="ball" type="State/RigidBody" shape="round" mass="5" color="0.4 0.7 0.5" position="-0.8 0 0.2"/>
  <component id="sticks" type="State/RigidBody" shape="cube" mass="3" color="0.7 0.5 0.8" position="1.5718 0 0.4317" orientation="0.968912421710645 0 0.247403959254523 0"/>
  <component id="weight" type="Field/Gravity" between="*"/>
  <component id="contact" type="CDetection/ODE" between="*" response="Response/Automatic" response.friction="0.9"/></plab>`;

// Boxes that lie on the ground and one that falls, so that it is never still.
function lyingBodies(count) {
  const side = Math.ceil(Math.sqrt(count)), lines = [`<plab version="1"><scene title="${count} on the ground" dt="1/60"/>`,
    '<component id="floor" type="Shape/Plane"/><component id="ground" type="State/Static" shape="floor"/><component id="box" type="Shape/Box" half_extents="0.25 0.2 0.15"/>'];
  for (let i = 0; i < count; ++i) lines.push(`<component id="o${i}" type="State/RigidBody" mass="${1 + (i % 7)}" shape="box" position="${i % side} ${Math.floor(i / side)} 0.15"/>`);
  return `${lines.join('\n')}<component id="weight" type="Field/Gravity" between="*"/><component id="contact" type="CDetection/ODE" between="*" response="Response/Rows" response.manager="Manager/SoftStep"/></plab>\n`;
}

async function show(text, objects) {
  if (server) {
    server.kill('SIGTERM');
    await server.ended;
  }
  const scene = join(lab.folder, 'forces.xml');
  writeFileSync(scene, text);
  server = await lab.server(scene, '--rate', 'real');
  if (page) await lab.shows(page, objects, 60000);
}

before(async () => {
  await show(kHeaps, 9);
  await lab.web();
  await lab.launch(chromium);
  page = await lab.page(9);
  await page.evaluate(() => { plab.view.judgedAt = Infinity; });
});
after(() => lab.end());

test('nobody asks for forces: none are read', async () => {
  await sleep(1000);
  assert.equal(await contactsOf(page), null);
  const topics = await lab.control('topics');
  assert.equal(topics.topics.find((t) => t.topic === 'plab/contacts').readers, 0);
});

test('arrows are the forces, on what moves, and the longest is written', async () => {
  await page.click('#show-forces');
  await until('contacts come', async () => (await contactsOf(page))?.points.length > 20);
  await until('the ball lies still', async () => (await contactsOf(page)).time > 2);
  const { points } = await contactsOf(page);
  const onGround = points.filter((p) => p.b === 'ground').reduce((sum, p) => sum + p.normal, 0);
  assert.ok(Math.abs(onGround - 15 * kG) < 0.02 * 15 * kG, `the ground carries ${onGround} N`);
  const slope = points.filter((p) => p.a === 'slope' || p.b === 'slope'), friction = Math.hypot(...slope.reduce((sum, p) => sum.map((v, i) => v + p.friction[i]), [0, 0, 0]));
  assert.ok(Math.abs(friction - 3 * kG * Math.sin(0.5)) < 0.5, `the slope holds it by ${friction} N`);
  await until('they are drawn', () => page.evaluate(() => plab.view.marks.pressing.mesh.count >= 20));
  const seen = await page.evaluate(() => {
    const { mesh, full } = plab.view.marks.pressing, out = [];
    for (let i = 0; i < mesh.count; ++i) out.push([...mesh.instanceMatrix.array.slice(16 * i + 8, 16 * i + 15)]);
    return { full, arrows: out };
  });
  assert.ok(seen.arrows.length >= 20, `${seen.arrows.length} arrows`);
  assert.ok(seen.full > 4.99 * kG && seen.full < 5 * kG * 1.6, `the longest is ${seen.full} N`);
  // The third column of a matrix is along the arrow: upwards, as all of it moves and lies on something.
  assert.ok(seen.arrows.every(([, , z]) => z > 0), 'all point upwards');
  await until('the scale is written', async () => /↑ [\d.]+ N/.test(await page.$eval('#force-scale', (e) => e.textContent)));
});

test('what is selected tells what it touches', async () => {
  await page.evaluate(() => plab.model.select('b0'));
  const rows = await until('the table comes', () => page.$$eval('#details .contacts tbody tr', (all) => all.map((row) => [...row.children].map((cell) => cell.textContent))).then((all) => all.length === 2 && all));
  assert.deepEqual(rows.map(([other, , points]) => [other, points]), [['ground', '4'], ['b1', '4']]);
  assert.ok(Math.abs(Number(rows[0][3]) - 10 * kG) < 0.02 * 10 * kG && Math.abs(Number(rows[1][3]) - 8 * kG) < 0.02 * 10 * kG, JSON.stringify(rows));
  await sleep(300);
  await shot(page, 'web-forces');
  await page.select('#theme', 'dark');
  await sleep(500);
  await shot(page, 'web-forces-dark');
  await page.select('#theme', 'auto');
});

test('a paused scene keeps its forces, and gets new ones with a step', async () => {
  await ask(page, { verb: 'pause' });
  await sleep(500);
  const { time } = await contactsOf(page);
  await sleep(500);
  assert.equal((await contactsOf(page)).time, time);
  await page.click('#step');
  await until('the step has brought new ones', async () => (await contactsOf(page)).time > time);
  await ask(page, { verb: 'resume' });
});

test('when nobody looks at forces any more, none are read', async () => {
  await page.click('#show-forces');
  await page.evaluate(() => plab.model.select(null));
  await until('the reader is gone', async () => (await lab.control('topics')).topics.find((t) => t.topic === 'plab/contacts').readers === 0);
  assert.equal(await page.evaluate(() => plab.view.marks.pressing.mesh.count), 0);
});

test('ten thousand bodies that lie on the ground: the page draws on', async () => {
  await show(lyingBodies(10000), 10001);
  await page.evaluate(() => {
    plab.view.judgedAt = null;
    plab.view.fitAll();
  });
  const measure = async () => {
    const look = () => page.evaluate(() => ({ pictures: plab.view.pictures, bytes: plab.socket.bytes, at: performance.now() }));
    await sleep(8000); // until it has given up what is too slow
    const a = await look();
    await sleep(5000);
    const b = await look(), seconds = (b.at - a.at) / 1000;
    return { pictures: (b.pictures - a.pictures) / seconds, megabytes: (b.bytes - a.bytes) / seconds / 1e6 };
  };
  const without = await measure();
  await page.click('#show-forces');
  await until('contacts come', async () => (await contactsOf(page))?.points.length >= 512, 30000);
  const with_ = await measure();
  const part = await page.evaluate(() => {
    const begin = performance.now();
    for (let i = 0; i < 50; ++i) {
      plab.view.marks.pressing.fitted = null;
      plab.view.marks.update(performance.now(), 1, 0.1);
    }
    return (performance.now() - begin) / 50;
  });
  console.log(`10,000 bodies on the ground with forces: ${with_.pictures.toFixed(1)} pictures/s, ${with_.megabytes.toFixed(2)} MB/s; without ${without.pictures.toFixed(1)} and ${without.megabytes.toFixed(2)}; arrows take ${part.toFixed(2)} ms of a picture`);
  assert.ok(with_.pictures > 1);
  assert.ok(part < 10, 'arrows leave most of the 50 ms of a picture at 20 a second');
  assert.ok((await contactsOf(page)).leftOut > 30000);
  await shot(page, 'web-forces-many');
});

test('no page had an error', () => assert.deepEqual(lab.troubles, []));
