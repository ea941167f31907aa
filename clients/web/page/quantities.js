// Numbers over time by name: "red.position.x", "gears.cost", "energy.kinetic".
import { vector } from './dom.js';

const kBody = { position: 0, velocity: 7, angular_velocity: 10 };
const kPart = { x: 0, y: 1, z: 2 };
const kEnergy = { kinetic: 1, stored: 2, work: 3, of_requests: 4, unexplained: 5 };

export class Quantities {
  constructor(model) { this.model = model; }

  // { component, unit, ofFrame(moment), ofMetrics() }: one of the functions, which give a number or null. Null: there is no such quantity.
  find(name) {
    if (name.startsWith('energy.')) {
      const column = kEnergy[name.slice(7)];
      return column ? { unit: 'J', ofMetrics: () => this.model.energy.at(-1)?.[column] ?? null } : null;
    }
    if (name === 'step.time') return { unit: 'ms', ofMetrics: () => (this.model.metrics ? this.model.metrics.step_ns * 1e-6 : null) };
    if (name === 'contacts') return { unit: '', ofMetrics: () => this.model.metrics?.contacts ?? null };
    const owner = this.ownerOf(name);
    if (!owner) return null;
    const rest = name.slice(owner.id.length + 1).split('.');
    return owner.handle === undefined ? this.ofInteraction(owner, rest) : this.ofObject(owner, rest);
  }

  // Ids may have dots: the longest that fits.
  ownerOf(name) {
    for (let end = name.lastIndexOf('.'); end > 0; end = name.lastIndexOf('.', end - 1)) {
      const id = name.slice(0, end);
      const thing = this.model.objects.get(id) ?? this.model.interactions.get(id);
      if (thing) return thing;
    }
    return null;
  }

  ofObject(object, [name, part]) {
    if (object.kind === 'shaft') {
      const column = { angle: 0, speed: 1 }[name];
      if (column === undefined) return null;
      return { component: object.id, unit: column ? 'rad/s' : 'rad', ofFrame: (moment) => {
        const place = moment.layout.shafts.get(object.handle);
        return place === undefined ? null : moment.shafts[2 * place + column];
      } };
    }
    const first = kBody[name], offset = kPart[part];
    if (first === undefined || (part !== undefined && offset === undefined)) return null;
    const unit = name === 'position' ? 'm' : name === 'velocity' ? 'm/s' : 'rad/s';
    return { component: object.id, unit, ofFrame: (moment) => {
      const exact = moment.exact.get(object.handle);
      if (!exact) return null;
      return offset === undefined ? Math.hypot(exact[first], exact[first + 1], exact[first + 2]) : exact[first + offset];
    } };
  }

  ofInteraction(interaction, [name, part]) {
    const row = () => this.model.rows.get(interaction.id);
    if (name === 'cost') return { component: interaction.id, unit: 'µs', ofMetrics: () => (row() ? row().cost * 1e-3 : null) };
    if (name === 'error') return { component: interaction.id, unit: '', ofMetrics: () => row()?.error ?? null };
    if (name === 'work') return { component: interaction.id, unit: 'J', ofMetrics: () => row()?.work ?? null };
    const output = () => this.model.outputs.get(interaction.id)?.find((o) => o.name === name);
    return { component: interaction.id, unit: output()?.unit ?? '', ofMetrics: () => {
      const text = output()?.text;
      if (text === undefined) return null;
      const three = vector(text);
      if (three) return part ? three[kPart[part]] : Math.hypot(...three);
      const value = Number(text);
      return Number.isFinite(value) ? value : null;
    } };
  }

  // Names to choose from.
  names() {
    const out = [...Object.keys(kEnergy).map((name) => `energy.${name}`), 'step.time', 'contacts'];
    for (const object of this.model.objects.values()) {
      if (out.length > 2000) break;
      if (object.kind === 'shaft') out.push(`${object.id}.angle`, `${object.id}.speed`);
      else if (object.motion !== 'static')
        for (const name of Object.keys(kBody)) out.push(`${object.id}.${name}`, ...Object.keys(kPart).map((part) => `${object.id}.${name}.${part}`));
    }
    for (const interaction of this.model.interactions.values()) {
      if (out.length > 4000) break;
      out.push(`${interaction.id}.cost`, `${interaction.id}.error`, `${interaction.id}.work`);
    }
    return out;
  }
}
