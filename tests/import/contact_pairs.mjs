// Compares the bodies that touch in the pose of a file with those that MuJoCo (compiled to WebAssembly) finds.
//
//   node contact_pairs.mjs FILE RESULT
//
// FILE: MJCF; RESULT: what plabd --out says of its blueprint, without a response to contacts. Exit code 1 and a line for each difference.
import loadMujoco from 'mujoco-js';
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';

const [file, result] = process.argv.slice(2);
const mujoco = await loadMujoco();
mujoco.FS.writeFile('/model.xml', readFileSync(file));
const model = mujoco.MjModel.loadFromXML('/model.xml'), data = new mujoco.MjData(model);
mujoco.mj_forward(model, data);

/// From the model's table of names, which end with a zero.
function nameAt(address) {
    let text = '';
    for (let i = address; model.names[i]; ++i) text += typeof model.names[i] === 'string' ? model.names[i] : String.fromCharCode(model.names[i]);
    return text;
}
const solidOf = (geom) => nameAt(model.name_bodyadr[model.body_weldid[model.geom_bodyid[geom]]]);
const pair = (a, b) => [a, b].sort().join(' ');

const theirs = new Set();
for (let i = 0; i < data.ncon; ++i) {
    const contact = data.contact.get(i);
    theirs.add(pair(solidOf(contact.geom1), solidOf(contact.geom2)));
}
const ours = new Set(JSON.parse(readFileSync(result, 'utf8')).contacts.map((c) => pair(c.a, c.b)));
const differences = [...[...ours].filter((p) => !theirs.has(p)).map((p) => `only in pLab: ${p}`),
                     ...[...theirs].filter((p) => !ours.has(p)).map((p) => `only in MuJoCo: ${p}`)];
for (const line of differences) console.log(`${basename(file)}: ${line}`);
console.log(`${basename(file)}: ${theirs.size} pairs touch in MuJoCo, ${ours.size} in pLab, ${differences.length} differ`);
process.exit(differences.length === 0 && theirs.size > 0 ? 0 : 1);
