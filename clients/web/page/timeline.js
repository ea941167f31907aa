// The line of time: what can be reached by a rewind, events on it, and a handle that goes back.
import { byId, h, seconds } from './dom.js';

const kColorOf = { failure: '#d43d2a', warning: '#d98200', swap: '#7b5cff', collision: '#ff3b6b', other: '#7a8896' };

function kindOf(event) {
  if (event.severity === 'failure') return 'failure';
  if (event.severity === 'warning') return 'warning';
  if (event.kind.startsWith('request.') || event.kind === 'level.changed') return 'swap';
  return event.kind.startsWith('collision.') ? 'collision' : 'other';
}

export class Timeline {
  // actions: { rewind(time), keep(name), restore(name) }
  constructor(model, actions) {
    this.model = model;
    this.canvas = byId('ticks');
    this.input = byId('time');
    this.list = byId('events');
    this.isDragged = false;
    this.input.addEventListener('input', () => {
      this.isDragged = true;
      this.describe(Number(this.input.value));
    });
    this.input.addEventListener('change', () => {
      this.isDragged = false;
      actions.rewind(Number(this.input.value));
    });
    byId('keep').addEventListener('click', () => {
      const taken = new Set((model.server?.snapshots ?? []).map((kept) => kept.name));
      let n = 1;
      while (taken.has(`moment-${n}`)) ++n;
      actions.keep(`moment-${n}`);
    });
    byId('snapshots').addEventListener('change', (event) => {
      if (event.target.value) actions.restore(event.target.value);
      event.target.value = '';
    });
    model.on('server', () => this.update());
    model.on('events', () => this.fillList());
    for (const topic of ['begin', 'run']) model.on(topic, () => this.fillList());
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    byId('severity').addEventListener('change', () => this.fillList());
  }

  get range() {
    const { server } = this.model;
    const end = server?.time ?? 0, from = server && server.rewind_from !== null ? server.rewind_from : 0;
    return [Math.min(from, end), Math.max(end, from + 1e-9)];
  }

  update() {
    const [from, to] = this.range, canRewind = this.model.server?.rewind_from !== null;
    this.input.min = from;
    this.input.max = to;
    this.input.step = this.model.server?.dt ?? 'any';
    this.input.disabled = !canRewind;
    if (!this.isDragged) this.input.value = to;
    this.fillKept(this.model.server?.snapshots ?? []);
    this.describe(this.isDragged ? Number(this.input.value) : to);
    this.draw();
  }

  fillKept(snapshots) {
    const key = JSON.stringify(snapshots.map((kept) => [kept.name, kept.run, kept.step]));
    if (key === this.kept) return;
    this.kept = key;
    byId('kept').hidden = snapshots.length === 0;
    byId('snapshots').replaceChildren(h('option', { value: '' }, '…'), ...snapshots.map((kept) => h('option', { value: kept.name }, `${kept.name}, ${seconds(kept.time)}`)));
  }

  describe(time) {
    this.input.setAttribute('aria-valuetext', `${time.toFixed(2)} seconds`);
    byId('time-text').textContent = this.isDragged ? `back to ${seconds(time)}` : `${seconds(this.range[0])} to ${seconds(time)}`;
  }

  draw() {
    const scale = devicePixelRatio, width = this.canvas.clientWidth * scale, height = this.canvas.clientHeight * scale;
    if (width < 2) return;
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    const paint = this.canvas.getContext('2d'), [from, to] = this.range;
    paint.clearRect(0, 0, width, height);
    for (const event of this.model.events) {
      if (event.time < from || event.isUndone) continue;
      const kind = kindOf(event);
      paint.fillStyle = kColorOf[kind];
      const tall = kind === 'other' ? 0.35 : kind === 'collision' ? 0.6 : 1;
      paint.fillRect(((event.time - from) / (to - from)) * (width - 2 * scale), height * (1 - tall), 1.5 * scale, height * tall);
    }
  }

  fillList() {
    this.draw();
    const least = byId('severity').value, rank = { info: 0, warning: 1, failure: 2 };
    const newest = this.model.events.filter((event) => (rank[event.severity] ?? 2) >= rank[least]).slice(-150).reverse();
    this.list.replaceChildren(...newest.map((event) => h(`li.${kindOf(event)}${event.isUndone ? '.undone' : ''}`, {}, h('time', {}, event.time.toFixed(3)), h('b', {}, event.kind), h('span', {}, event.text))));
    if (newest.length === 0) this.list.replaceChildren(h('li.hint', {}, 'Nothing has happened yet.'));
  }
}
