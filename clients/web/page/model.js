// What the page knows of the scene. Whoever shows something of it listens for the topics that change it.

export class Model {
  constructor() {
    this.listeners = new Map();
    this.server = null;
    this.playback = null; // { from, to, at, rate, paused }: where the recording is that is played
    this.scene = null;
    this.objects = new Map();
    this.shapes = new Map();
    this.interactions = new Map();
    this.types = new Map();
    this.byHandle = new Map();
    this.metrics = null;
    this.rows = new Map(); // component -> { resolved, cost, error, work }
    this.details = new Map(); // component -> parameters
    this.outputs = new Map(); // component -> outputs, of the newest metrics
    this.contacts = null; // { time, left_out, pairs, points }: what presses on what
    this.events = []; // { time, kind, text, severity, component }
    this.energy = []; // [time, kinetic, stored, work, of_requests, unexplained, step_ns, rate]
    this.selected = null;
    this.state = { kind: 'wait', text: 'Connecting to plab-web.' };
  }

  on(topic, listener) {
    if (!this.listeners.has(topic)) this.listeners.set(topic, []);
    this.listeners.get(topic).push(listener);
  }

  tell(topic, value) { for (const listener of this.listeners.get(topic) ?? []) listener(value); }

  setState(kind, text) {
    if (this.state.kind === kind && this.state.text === text) return;
    this.state = { kind, text };
    this.tell('state');
  }

  select(id) {
    if (id === this.selected) return;
    this.selected = id;
    this.tell('selected', id);
  }

  isShaft(object) { return object.kind === 'shaft'; }

  take(message) {
    const by = {
      scene: () => this.takeScene(message),
      changes: () => this.takeChanges(message),
      server: () => this.takeServer(message.server),
      metrics: () => this.takeMetrics(message),
      detail: () => {
        this.details.set(message.id, message.parameters);
        this.tell('detail', message.id);
      },
      history: () => this.takeHistory(message),
      events: () => this.takeEvents(message.entries.map(eventOf), message.left_out),
      collisions: () => this.takeCollisions(message),
      contacts: () => this.takeContacts(message),
      gone: () => this.setState('gone', message.reason),
      error: () => this.tell('trouble', message.reason),
    };
    by[message.type]?.();
  }

  takeScene(message) {
    // What was before is no past of another server.
    if (message.server && this.server?.started_ns !== message.server.started_ns) {
      this.events = [];
      this.energy = [];
      this.metrics = null;
    }
    this.isOther = !this.scene || this.scene.file !== message.scene?.file || this.scene.title !== message.scene?.title;
    const list = (items, key) => new Map(items.map((item) => [item[key], item]));
    this.scene = message.scene;
    this.objects = list(message.objects, 'id');
    this.shapes = list(message.shapes, 'id');
    this.interactions = list(message.interactions, 'id');
    this.types = list(message.types, 'name');
    this.rows.clear();
    this.details.clear();
    this.outputs.clear();
    this.contacts = null;
    this.heardAt = performance.now();
    this.setState('there', '');
    this.rebuild();
    this.tell('begin');
    if (message.server) this.takeServer(message.server);
    this.tell('structure');
    if (this.selected && !this.has(this.selected)) this.select(null);
  }

  takeChanges(message) {
    if (message.scene) this.scene = message.scene;
    for (const [key, name] of [['objects', 'id'], ['shapes', 'id'], ['interactions', 'id'], ['types', 'name']]) {
      for (const item of message[key] ?? []) this[key].set(item[name], item);
      for (const id of message.gone?.[key] ?? []) this[key].delete(id);
    }
    this.rebuild();
    this.tell('structure');
    if (this.selected && !this.has(this.selected)) this.select(null);
  }

  has(id) { return this.objects.has(id) || this.interactions.has(id); }

  rebuild() { this.byHandle = new Map(Array.from(this.objects.values(), (object) => [object.handle, object])); }

  takeServer(server) {
    const before = this.server;
    this.server = server;
    this.heardAt = performance.now();
    if (this.state.kind !== 'there') this.setState('there', '');
    if (before && (before.run !== server.run || before.started_ns !== server.started_ns)) {
      // After a reset nothing is left of what was; after a rewind, what was before that time.
      for (const event of this.events) event.isUndone ||= event.time > server.time;
      this.energy = this.energy.filter((row) => row[0] <= server.time);
      this.forgetContacts();
      this.tell('run', server.run);
    }
    this.tell('server', server);
  }

  takeMetrics(metrics) {
    this.metrics = metrics;
    for (const [id, resolved, cost, error, work, quarantined] of metrics.interactions) this.rows.set(id, { resolved, cost, error, work, quarantined });
    this.outputs = new Map(Object.entries(metrics.watched));
    const e = metrics.energy;
    const last = this.energy.at(-1);
    if (!last || metrics.time > last[0]) {
      this.energy.push([metrics.time, e.kinetic, e.stored, e.work, e.of_requests, e.unexplained, metrics.step_ns, metrics.real_time_factor]);
      if (this.energy.length > 2400) this.energy.shift();
    } else if (metrics.time < last[0]) {
      while (this.energy.length && this.energy.at(-1)[0] >= metrics.time) this.energy.pop();
    }
    this.tell('metrics', metrics);
  }

  // The force of a point is that on the second body of its pair.
  takeContacts({ time, left_out, pairs, points }) {
    this.contacts = {
      time, leftOut: left_out,
      points: points.map((row) => {
        const [a, b, asleep] = pairs[row[0]], friction = row.slice(7, 10), [normal, depth, impact] = row.slice(10);
        const force = friction.map((value, i) => value + normal * row[4 + i]);
        return { a, b, asleep, at: row.slice(1, 4), friction, normal, depth, force, isImpact: impact === 1 };
      }),
    };
    this.tell('contacts', this.contacts);
  }

  forgetContacts() {
    this.contacts = null;
    this.tell('contacts', null);
  }

  takeHistory(message) {
    this.events = message.events.map(eventOf);
    for (const event of this.events) event.isUndone = event.run !== undefined && event.run !== this.server?.run;
    this.energy = message.metrics;
    this.tell('events');
  }

  takeEvents(entries, leftOut) {
    this.events.push(...entries);
    if (leftOut) this.events.push({ time: entries.at(-1)?.time ?? 0, kind: 'page.left_out', severity: 'info', text: `${leftOut} more at that moment, not shown`, component: '' });
    if (this.events.length > 2000) this.events.splice(0, this.events.length - 2000);
    this.tell('events', entries);
  }

  takeCollisions(message) {
    this.tell('collisions', message.entries);
    this.takeEvents(message.entries.map((c) => ({
      time: c.time, kind: `collision.${c.kind}`, severity: 'info', component: c.detector, a: c.a, b: c.b,
      text: `${c.a} and ${c.b}${length(c.impulse) > 0 ? `, impulse ${length(c.impulse).toPrecision(4)} N s` : ''}`,
    })), message.left_out);
  }
}

const length = (v) => Math.hypot(...v);

function eventOf(event) {
  const who = [event.a, event.b].filter(Boolean).join(' and ');
  return {
    run: event.run, time: event.time, kind: event.kind, severity: event.severity, component: event.component, a: event.a, b: event.b,
    text: [event.component, who, event.message].filter(Boolean).join(': '),
  };
}
