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

function proof(report) {
  const size = (v) => Math.hypot(...v);
  const { with_old: old, with_new: now } = report;
  const difference = old.momentum.map((value, i) => now.momentum[i] - value);
  const row = (name, a, b, c, unit) => h('tr', {}, h('th', { scope: 'row' }, name, h('small', {}, ` ${unit}`)), h('td', {}, number(a, 5)), h('td', {}, number(b, 5)), h('td', {}, number(c, 3)));
  return h('table', {}, h('caption', {}, `First step after it; energy before it ${number(report.energy_before, 6)} J`),
    h('thead', {}, h('tr', {}, h('td'), h('th', { scope: 'col' }, 'old'), h('th', { scope: 'col' }, 'new'), h('th', { scope: 'col' }, 'jump'))),
    h('tbody', {},
      row('energy', old.energy, now.energy, now.energy - old.energy, 'J'),
      row('momentum', size(old.momentum), size(now.momentum), size(difference), 'N s'),
      row('error', old.error, now.error, now.error - old.error, ''),
      h('tr', {}, h('th', { scope: 'row' }, 'cost'), ...[old.cost_ns, now.cost_ns].map((cost) => h('td', {}, duration(cost))), h('td', {}, old.cost_ns > 0 && now.cost_ns > 0 ? `${number((100 * (now.cost_ns - old.cost_ns)) / old.cost_ns, 2)} %` : '–'))));
}

function fates(fields) {
  const by = new Map();
  for (const [name, fate] of Object.entries(fields)) by.set(fate, [...(by.get(fate) ?? []), name]);
  return h('p.fates', {}, [...by].map(([fate, names]) => `${fate}: ${names.join(', ')}`).join('; ') || 'It has no values to carry over.');
}
