// The line of time: what can be reached by a rewind, events on it, and a handle that goes back.
import { byId, h, seconds } from './dom.js';

const kScrub = 80; // ms between moments that are asked for while the handle is dragged
const kColorOf = { failure: '#d43d2a', warning: '#d98200', swap: '#7b5cff', collision: '#ff3b6b', other: '#7a8896' };

function kindOf(event) {
  if (event.severity === 'failure') return 'failure';
  if (event.severity === 'warning') return 'warning';
  if (event.kind.startsWith('request.') || event.kind === 'level.changed') return 'swap';
  return event.kind.startsWith('collision.') ? 'collision' : 'other';
}

export class Timeline {
  // actions: { rewind(time), seek(time), keep(name), restore(name) }; of a playback the line is that of the recording, and seek() moves on it
  constructor(model, actions) {
    this.model = model;
    this.canvas = byId('ticks');
    this.input = byId('time');
    this.list = byId('events');
    this.isDragged = false;
    this.input.addEventListener('input', () => {
      this.isDragged = true;
      this.describe(Number(this.input.value));
      if (this.model.playback) this.scrub(actions);
    });
    this.input.addEventListener('change', () => {
      const time = Number(this.input.value);
      clearTimeout(this.later);
      this.later = null;
      if (this.model.playback) this.model.playback = { ...this.model.playback, at: time }; // until the playback says so itself
      this.isDragged = false;
      if (this.model.playback) actions.seek(time);
      else actions.rewind(time);
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
    for (const topic of ['server', 'playback']) model.on(topic, () => this.update());
    model.on('events', () => this.fillList());
    for (const topic of ['begin', 'run']) model.on(topic, () => this.fillList());
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    byId('severity').addEventListener('change', () => this.fillList());
  }

  // plabd says where it is once a second; what is drawn says it more often. `time`: s, of what is drawn.
  follow(time) {
    this.drawn = time ?? 0;
    if (!this.isDragged && !this.model.playback) this.update();
  }

  // A playback follows the handle, a few times a second.
  scrub(actions) {
    this.later ??= setTimeout(() => {
      this.later = null;
      actions.seek(Number(this.input.value));
    }, kScrub);
  }

  get range() {
    const { server, playback } = this.model;
    if (playback) return [playback.from, Math.max(playback.to, playback.from + 1e-9)];
    // Not that of before a reset or a rewind.
    const isNewer = server && this.drawn > server.time && this.drawn < server.time + 2 * Math.max(1, server.rate_reached);
    const end = isNewer ? this.drawn : server?.time ?? 0, from = server && server.rewind_from !== null ? server.rewind_from : 0;
    return [Math.min(from, end), Math.max(end, from + 1e-9)];
  }

  update() {
    const { playback, server } = this.model, [from, to] = this.range, canMove = playback !== null || server?.rewind_from !== null;
    this.input.min = from;
    this.input.max = to;
    this.input.step = playback ? 'any' : server?.dt ?? 'any';
    this.input.disabled = !canMove;
    this.input.setAttribute('aria-label', playback ? 'Time of the recording' : 'Time: go back to');
    if (!this.isDragged) this.input.value = playback ? playback.at : to;
    this.fillKept(server?.snapshots ?? []);
    this.describe(this.isDragged ? Number(this.input.value) : playback ? playback.at : to);
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
    const { playback } = this.model;
    byId('time-text').textContent = playback ? `${seconds(time - playback.from)} of ${seconds(playback.to - playback.from)}` : this.isDragged ? `back to ${seconds(time)}` : `${seconds(this.range[0])} to ${seconds(time)}`;
  }

  draw() {
    const scale = devicePixelRatio, width = this.canvas.clientWidth * scale, height = this.canvas.clientHeight * scale;
    if (width < 2) return;
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    const paint = this.canvas.getContext('2d'), [from, to] = this.range;
    paint.clearRect(0, 0, width, height);
    // The line of a recording has its own zero.
    const { playback, server } = this.model, shift = playback ? playback.at - (server?.time ?? 0) : 0;
    for (const event of this.model.events) {
      if (event.time + shift < from || event.isUndone) continue;
      const kind = kindOf(event);
      paint.fillStyle = kColorOf[kind];
      const tall = kind === 'other' ? 0.35 : kind === 'collision' ? 0.6 : 1;
      paint.fillRect(((event.time + shift - from) / (to - from)) * (width - 2 * scale), height * (1 - tall), 1.5 * scale, height * tall);
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
