// Has Khronos' validator check a film, and compares where it has bodies at its end with a trace: node check_gltf.mjs FILM.glb TRACE.csv
// Exit code 1 and a line for each error, warning or difference.
import validator from 'gltf-validator';
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';

const [film, trace] = process.argv.slice(2);
const bytes = new Uint8Array(readFileSync(film));
const report = await validator.validateBytes(bytes, { maxIssues: 20 });
const troubles = report.issues.messages.filter((m) => m.severity <= 1).map((m) => `${m.code} at ${m.pointer}: ${m.message}`);

// The container: 12 bytes, then chunks of length, type and data.
const view = new DataView(bytes.buffer, bytes.byteOffset);
const jsonLength = view.getUint32(12, true);
const gltf = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + jsonLength)));
const binary = 20 + jsonLength + 8;
function floats(accessor) {
    const { bufferView, count, type } = gltf.accessors[accessor], width = { SCALAR: 1, VEC3: 3, VEC4: 4 }[type];
    const start = binary + gltf.bufferViews[bufferView].byteOffset;
    return [...Array(count * width).keys()].map((i) => view.getFloat32(start + 4 * i, true));
}

const [head, ...rows] = readFileSync(trace, 'utf8').trim().split('\n').map((line) => line.split(','));
const last = rows[rows.length - 1], animation = gltf.animations[0];
let compared = 0;
for (const { sampler, target } of animation.channels) {
    const column = head.indexOf(`${gltf.nodes[target.node].name}.position.x`);
    if (target.path !== 'translation' || column < 0) continue;
    const { input, output } = animation.samplers[sampler], values = floats(output).slice(-3), end = floats(input).slice(-1)[0];
    const differs = (a, b) => Math.abs(a - b) > 1e-5 * Math.max(1, Math.abs(b));
    if (differs(end, Number(last[head.indexOf('time')]))) troubles.push(`ends at ${end} s`);
    for (let k = 0; k < 3; ++k, ++compared)
        if (differs(values[k], Number(last[column + k]))) troubles.push(`${head[column + k]}: ${values[k]}, in the trace ${last[column + k]}`);
}
if (compared === 0) troubles.push('no body of the trace moves in the film');
for (const line of troubles) console.log(`${basename(film)}: ${line}`);
const { info } = report;
console.log(`${basename(film)}: ${info.totalTriangleCount} triangles, ${animation.channels.length} channels, ${compared} values compared, ${troubles.length} troubles`);
process.exit(troubles.length === 0 ? 0 : 1);
