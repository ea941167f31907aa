// pLab's programs for tests in node. Everything that is started here ends with end().
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

export async function until(what, condition, ms = 15000) {
  const end = Date.now() + ms;
  for (;;) {
    const value = await condition();
    if (value) return value;
    if (Date.now() > end) throw new Error(`within ${ms} ms it did not happen that ${what}`);
    await sleep(50);
  }
}

export class Programs {
  constructor(bin) {
    this.bin = bin;
    this.domain = String(20 + (process.pid % 200));
    this.folder = mkdtempSync(join(tmpdir(), 'plab-test-'));
    this.children = new Set();
  }

  start(program, ...args) {
    // It ends with this process, however that ends.
    const child = spawn('setpriv', ['--pdeathsig', 'KILL', join(this.bin, program), ...args], { env: { ...process.env, PLAB_DOMAIN: this.domain }, stdio: ['ignore', 'pipe', 'pipe'], cwd: this.folder });
    child.text = '';
    for (const stream of [child.stdout, child.stderr]) stream.on('data', (data) => { child.text += data; });
    child.ended = new Promise((resolve) => child.on('exit', (code) => {
      this.children.delete(child);
      resolve(code);
    }));
    this.children.add(child);
    return child;
  }

  async server(scene, ...args) {
    const child = this.start('plabd', scene, '--name', 'lab', ...args);
    await until('plabd is ready', () => child.text.includes('ready after'));
    return child;
  }

  // What plabctl prints as JSON: the server's own word.
  async control(...args) {
    const child = this.start('plabctl', '--json', ...args);
    await child.ended;
    return JSON.parse(child.text);
  }

  async end() {
    for (const child of this.children) child.kill('SIGTERM');
    await Promise.race([Promise.all([...this.children].map((child) => child.ended)), sleep(5000)]);
    for (const child of this.children) child.kill('SIGKILL');
    rmSync(this.folder, { recursive: true, force: true, maxRetries: 5 });
  }
}

// Processor time that a process has used, s, and its memory, MB.
const kTicks = 100; // clock ticks of /proc per second
export function cpu(pid) {
  const words = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ');
  return (Number(words[11]) + Number(words[12])) / kTicks;
}
export const memory = (pid) => Number(readFileSync(`/proc/${pid}/status`, 'utf8').match(/VmRSS:\s+(\d+)/)[1]) / 1024;

// A scene of many bodies that drift and turn.
export function manyBodies(count) {
  const side = Math.ceil(Math.sqrt(count)), lines = [`<plab version="1"><scene title="${count} bodies" dt="1/60" solver="Solver/SemiImplicitEuler"/>`,
    '<component id="ball" type="Shape/Sphere" radius="0.25"/><component id="box" type="Shape/Box" half_extents="0.25 0.2 0.15"/>'];
  for (let i = 0; i < count; ++i)
    lines.push(`<component id="o${i}" type="State/RigidBody" mass="1" shape="${i % 2 ? 'box' : 'ball'}" color="${(i % 10) / 10} 0.5 ${1 - (i % 10) / 10}" position="${i % side} ${Math.floor(i / side)} 1" linear_velocity="0 0 ${0.02 * ((i * 7) % 11 - 5)}" angular_velocity="${(i % 5) - 2} 1 2"/>`);
  return `${lines.join('\n')}\n</plab>\n`;
}

export const readText = (file) => readFileSync(file, 'utf8');
