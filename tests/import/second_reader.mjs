// Compares imported scenes with what MuJoCo (compiled to WebAssembly) makes of the same file: masses, centres, inertias, limits, rotors and
// dampers of joints; and, where asked for, how the bodies move.
//
//   node second_reader.mjs FILE BLUEPRINT [TRACE [ACTUATOR=CONTROL ..]]
//
// FILE: MJCF or URDF; BLUEPRINT: what plabd --import made of it; TRACE: of plabd --trace, with these controls of its actuators.
// Exit code 1 and a line for each difference.
import loadMujoco from 'mujoco-js';
import { readdirSync, readFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';

const [file, blueprint, trace, ...controls] = process.argv.slice(2);
const differences = [];
let compared = 0;
function check(what, ours, theirs, tolerance) {
    ++compared;
    const scale = Math.max(1, Math.abs(theirs));
    if (!(Math.abs(ours - theirs) <= tolerance * scale)) differences.push(`${what}: pLab ${ours}, MuJoCo ${theirs}`);
}

// ---- what pLab has: the components of the blueprint, by id

function components(text) {
    const found = new Map();
    for (const [, id, type, rest] of text.matchAll(/<component id="([^"]*)" type="([^"]*)"([^>]*)>/g)) {
        const fields = Object.fromEntries([...rest.matchAll(/(\w+)="([^"]*)"/g)].map(([, name, value]) => [name, value]));
        found.set(id, { type, ...fields });
    }
    return found;
}
const numbers = (text) => text.trim().split(/\s+/).map(Number);
const number = (component, field, otherwise) => (component?.[field] === undefined ? otherwise : Number(component[field]));

// ---- what MuJoCo has

const mujoco = await loadMujoco();
// The file, and what it may include: XML files beside it and in folders there.
const path = '/' + basename(file).replace(/\.mjcf$/, '.xml');
for (const entry of readdirSync(dirname(file), { recursive: true })) {
    if (!entry.endsWith('.xml')) continue;
    const folders = dirname(entry).split('/');
    folders.forEach((_, i) => { try { mujoco.FS.mkdir('/' + folders.slice(0, i + 1).join('/')); } catch { /* it is there */ } });
    mujoco.FS.writeFile('/' + entry, readFileSync(join(dirname(file), entry)));
}
mujoco.FS.writeFile(path, readFileSync(file));
const model = mujoco.MjModel.loadFromXML(path);
const data = new mujoco.MjData(model);
mujoco.mj_forward(model, data);
/// From the model's table of names, which end with a zero; '' for what has none.
function nameAt(address) {
    let text = '';
    for (let i = address; model.names[i]; ++i) text += typeof model.names[i] === 'string' ? model.names[i] : String.fromCharCode(model.names[i]);
    return text;
}
const bodyName = (i) => nameAt(model.name_bodyadr[i]) || `body.${i}`;
const jointName = (j) => nameAt(model.name_jntadr[j]);
const vector = (array, i) => [array[3 * i], array[3 * i + 1], array[3 * i + 2]];
const matrix = (array, i) => [0, 1, 2].map((row) => [0, 1, 2].map((column) => array[9 * i + 3 * row + column]));

/// Mass, centre and inertia of a body and all that is welded to it, in the body's axes: from MuJoCo's principal moments in the world.
function solid(body) {
    const members = [...Array(model.nbody).keys()].filter((i) => model.body_weldid[i] === body);
    const mass = members.reduce((sum, i) => sum + model.body_mass[i], 0);
    const center = [0, 1, 2].map((k) => members.reduce((sum, i) => sum + model.body_mass[i] * data.xipos[3 * i + k], 0) / mass);
    const inertia = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
    for (const i of members) {
        const R = matrix(data.ximat, i), moments = vector(model.body_inertia, i), d = vector(data.xipos, i).map((x, k) => x - center[k]);
        const square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        for (let r = 0; r < 3; ++r)
            for (let c = 0; c < 3; ++c) {
                for (let k = 0; k < 3; ++k) inertia[r][c] += R[r][k] * moments[k] * R[c][k];
                inertia[r][c] += model.body_mass[i] * ((r === c ? square : 0) - d[r] * d[c]);
            }
    }
    const X = matrix(data.xmat, body), o = vector(data.xpos, body);
    const turned = [0, 1, 2].map((a) => [0, 1, 2].map((b) => {
        let sum = 0;
        for (let r = 0; r < 3; ++r) for (let c = 0; c < 3; ++c) sum += X[r][a] * inertia[r][c] * X[c][b];
        return sum;
    }));
    return { mass, center: [0, 1, 2].map((a) => X[0][a] * (center[0] - o[0]) + X[1][a] * (center[1] - o[1]) + X[2][a] * (center[2] - o[2])), inertia: turned };
}

const ours = components(readFileSync(blueprint, 'utf8'));

function compareBodies() {
    for (let i = 1; i < model.nbody; ++i) {
        if (model.body_weldid[i] !== i) continue;
        const id = bodyName(i), body = ours.get(id), theirs = solid(i);
        if (!body) { differences.push(`there is no body ${id}`); continue; }
        check(`${id}.mass`, Number(body.mass), theirs.mass, 1e-9);
        const center = numbers(body.center_of_mass), [xx, yy, zz, xy = 0, xz = 0, yz = 0] = numbers(body.inertia);
        for (let k = 0; k < 3; ++k) check(`${id}.center_of_mass[${k}]`, center[k], theirs.center[k], 1e-9);
        const I = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], size = Math.max(xx, yy, zz);
        for (let r = 0; r < 3; ++r) for (let c = 0; c < 3; ++c) check(`${id}.inertia[${r}${c}] / largest`, I[r][c] / size, theirs.inertia[r][c] / size, 1e-8);
    }
}

/// The id of the hinge or slider that came from the joint: that of the joint, with a number where a body has the name as well.
function jointId(joint) {
    for (const id of [joint, `${joint}.1`]) if (/Hinge|Slider/.test(ours.get(id)?.type ?? '')) return id;
    return undefined;
}

function compareJoints() {
    for (let j = 0; j < model.njnt; ++j) {
        const kind = model.jnt_type[j];
        if (kind !== mujoco.mjtJoint.mjJNT_HINGE.value && kind !== mujoco.mjtJoint.mjJNT_SLIDE.value) continue;
        const id = jointId(jointName(j));
        if (!id) { differences.push(`there is no joint ${jointName(j)}`); continue; }
        const lower = model.jnt_range[2 * j], upper = model.jnt_range[2 * j + 1], zero = model.qpos0[model.jnt_qposadr[j]];
        const limit = ours.get(`${id}.limit`), limited = model.jnt_limited[j] !== 0;
        const start = limited ? Math.min(upper, Math.max(lower, zero)) : zero;
        check(`${id} is limited`, limit ? 1 : 0, limited ? 1 : 0, 0);
        if (limit && limited) {
            check(`${id}.lower`, number(limit, 'lower', -Infinity), lower - start, 1e-9);
            check(`${id}.upper`, number(limit, 'upper', Infinity), upper - start, 1e-9);
        }
        const dof = model.jnt_dofadr[j], spring = ours.get(`${id}.spring`);
        check(`${id}.damping`, number(spring, 'damping', 0), model.dof_damping[dof], 1e-9);
        check(`${id}.stiffness`, number(spring, 'stiffness', 0), model.jnt_stiffness[j], 1e-9);
        if (kind === mujoco.mjtJoint.mjJNT_HINGE.value) check(`${id}.armature`, number(ours.get(`${id}.rotor`), 'inertia', 0), model.dof_armature[dof], 1e-9);
    }
}

// ---- how it moves: positions of the bodies, with MuJoCo's RungeKutta4 at a twentieth of a millisecond

function compareMotion() {
    const [head, ...rows] = readFileSync(trace, 'utf8').trim().split('\n').map((line) => line.split(','));
    const last = rows[rows.length - 1], until = Number(last[head.indexOf('time')]);
    model.opt.timestep = until / Math.round(until / 5e-5), model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4.value;
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT.value;
    for (const control of controls) {
        const [actuator, value] = control.split('=');
        const index = [...Array(model.nu).keys()].find((i) => nameAt(model.name_actuatoradr[i]) === actuator);
        if (index === undefined) differences.push(`there is no actuator ${actuator}`);
        data.ctrl[index] = Number(value);
    }
    const steps = Math.round(until / model.opt.timestep);
    for (let i = 0; i < steps; ++i) mujoco.mj_step(model, data);
    for (let i = 1; i < model.nbody; ++i) {
        const id = bodyName(i);
        const column = head.indexOf(`${id}.position.x`);
        if (column < 0 || model.body_weldid[i] !== i) continue;
        for (let k = 0; k < 3; ++k) check(`${id}.position[${k}] at ${until} s`, Number(last[column + k]), data.xpos[3 * i + k], 1e-5);
    }
}

compareBodies();
compareJoints();
if (trace) compareMotion();
for (const line of differences) console.log(`${basename(file)}: ${line}`);
console.log(`${basename(file)}: ${compared} values compared, ${differences.length} differ`);
process.exit(differences.length === 0 && compared > 0 ? 0 : 1);
