// A reply to an exchange, as a card: what it cost, what it changed, and what the old algorithm would have given.
import { duration, h, number, shortType } from './dom.js';

export function swapCard(reply, id, wanted) {
  if (reply.outcome !== 'done') {
    return h('section.card.refused', { role: 'alert', tabIndex: -1 }, h('h3', {}, `Not exchanged for ${shortType(wanted)}`),
      ...reply.reasons.map((reason) => h('p', {}, reason)), h('p.sub', {}, reply.outcome === 'unanswered' ? '' : 'Nothing has changed.'));
  }
  const report = reply.swaps.find((swap) => swap.component === id) ?? reply.swaps[0];
  const children = [h('p.sub', {}, `Step ${reply.step}, ${reply.time.toFixed(3)} s. The loop stood still for ${duration(reply.pause_ns)}. Trial: ${reply.trial}.`)];
  if (report) children.push(proof(report), fates(report.fields));
  return h('section.card', { role: 'status', tabIndex: -1, 'aria-label': 'What the exchange did' },
    h('h3', {}, report ? `${shortType(report.from)} → ${shortType(report.to)}` : 'Exchanged'), ...children);
}

// What an exchange would do: the scene simulated with it and without it, beside the server.
export function previewCard(reply, wanted) {
  if (!reply.preview) return h('section.card.refused', { role: 'alert', tabIndex: -1 }, h('h3', {}, `No preview of ${shortType(wanted)}`), ...reply.reasons.map((reason) => h('p', {}, reason)));
  const { preview } = reply, { without, with: other } = preview, last = preview.differences.at(-1);
  const row = (name, a, b) => h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, a), h('td', {}, b));
  const ends = last && [`After ${number(last.time - preview.time, 3)} s `,
    last.farthest ? `${last.farthest} would be ${number(last.distance, 3)} m from where it is without the exchange, ` : 'no body would be elsewhere, ',
    last.most_turned ? `${last.most_turned} turned by ${number(last.turn, 3)} rad against it, ` : '', `and the energy higher by ${number(last.energy_with - last.energy_without, 3)} J.`].join('');
  return h('section.card', { role: 'status', tabIndex: -1, 'aria-label': 'What the exchange would do' },
    h('h3', {}, `If it were ${shortType(preview.to)}`), h('p', {}, ends ?? 'Nothing would differ.'),
    h('table', {}, h('caption', {}, `${preview.steps} steps from ${number(preview.time)} s on; nothing has changed in the scene`),
      h('thead', {}, h('tr', {}, h('td'), h('th', { scope: 'col' }, 'as it is'), h('th', { scope: 'col' }, 'with it'))),
      h('tbody', {}, row('cost of a step', duration(without.cost_ns_per_step), duration(other.cost_ns_per_step)),
        row('largest error', number(without.largest_error), number(other.largest_error)))));
}

// What was not measured is null, and stays so in sums.
const minus = (a, b) => (a === null || b === null ? null : a - b);
const size = (v) => (v.includes(null) ? null : Math.hypot(...v));

function proof(report) {
  const { with_old: old, with_new: now } = report;
  const difference = old.momentum.map((value, i) => minus(now.momentum[i], value));
  const row = (name, a, b, c, unit) => h('tr', {}, h('th', { scope: 'row' }, name, h('small', {}, ` ${unit}`)), h('td', {}, number(a, 5)), h('td', {}, number(b, 5)), h('td', {}, number(c, 3)));
  return h('table', {}, h('caption', {}, `First step after it; energy before it ${number(report.energy_before, 6)} J`),
    h('thead', {}, h('tr', {}, h('td'), h('th', { scope: 'col' }, 'old'), h('th', { scope: 'col' }, 'new'), h('th', { scope: 'col' }, 'jump'))),
    h('tbody', {},
      row('energy', old.energy, now.energy, minus(now.energy, old.energy), 'J'),
      row('momentum', size(old.momentum), size(now.momentum), size(difference), 'N s'),
      row('error', old.error, now.error, minus(now.error, old.error), ''),
      h('tr', {}, h('th', { scope: 'row' }, 'cost'), ...[old.cost_ns, now.cost_ns].map((cost) => h('td', {}, duration(cost))), h('td', {}, old.cost_ns > 0 && now.cost_ns > 0 ? `${number((100 * (now.cost_ns - old.cost_ns)) / old.cost_ns, 2)} %` : '–'))));
}

function fates(fields) {
  const by = new Map();
  for (const [name, fate] of Object.entries(fields)) by.set(fate, [...(by.get(fate) ?? []), name]);
  return h('p.fates', {}, [...by].map(([fate, names]) => `${fate}: ${names.join(', ')}`).join('; ') || 'It has no values to carry over.');
}
