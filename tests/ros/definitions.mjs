// The definitions of ROS 2 messages: of the common packages as Foxglove's package has them, of the others as their .msg and .srv files state
// them, without comments. Names are package/Type, as Foxglove's libraries want them.
import { createHash } from 'node:crypto';
import { ros2jazzy } from '@foxglove/rosmsg-msgs-common';
import { parse } from '@foxglove/rosmsg';

// simulation_interfaces 2.1.0, ros_gz_interfaces (Jazzy), rmw_dds_common (Iron and later).
const kOthers = {
  'rmw_dds_common/msg/Gid': 'char[16] data',
  'rmw_dds_common/msg/NodeEntitiesInfo': 'string<=256 node_namespace\nstring<=256 node_name\nGid[] reader_gid_seq\nGid[] writer_gid_seq',
  'rmw_dds_common/msg/ParticipantEntitiesInfo': 'Gid gid\nNodeEntitiesInfo[] node_entities_info_seq',
  'std_msgs/msg/UInt32': 'uint32 data',
  'ros_gz_interfaces/msg/Entity': 'uint64 id\nstring name\nuint8 type',
  'ros_gz_interfaces/msg/JointWrench': `std_msgs/Header header
std_msgs/String body_1_name
std_msgs/UInt32 body_1_id
std_msgs/String body_2_name
std_msgs/UInt32 body_2_id
geometry_msgs/Wrench body_1_wrench
geometry_msgs/Wrench body_2_wrench`,
  'ros_gz_interfaces/msg/Contact': `ros_gz_interfaces/Entity collision1
ros_gz_interfaces/Entity collision2
geometry_msgs/Vector3[] positions
geometry_msgs/Vector3[] normals
float64[] depths
ros_gz_interfaces/JointWrench[] wrenches`,
  'ros_gz_interfaces/msg/Contacts': 'std_msgs/Header header\nros_gz_interfaces/Contact[] contacts',
  'simulation_interfaces/msg/Result': 'uint8 result\nstring error_message',
  'simulation_interfaces/msg/Resource': 'string uri\nstring resource_string',
  'simulation_interfaces/msg/EntityCategory': 'uint8 category',
  'simulation_interfaces/msg/TagsFilter': 'string[] tags\nuint8 filter_mode',
  'simulation_interfaces/msg/Bounds': 'uint8 type\ngeometry_msgs/Vector3[] points',
  'simulation_interfaces/msg/EntityFilters': 'string filter\nEntityCategory[] categories\nTagsFilter tags\nBounds bounds',
  'simulation_interfaces/msg/EntityInfo': 'EntityCategory category\nstring description\nstring[] tags',
  'simulation_interfaces/msg/EntityState':
    'std_msgs/Header header\ngeometry_msgs/Pose pose\ngeometry_msgs/Twist twist\ngeometry_msgs/Accel acceleration',
  'simulation_interfaces/msg/SimulationState': 'uint8 state',
  'simulation_interfaces/msg/SimulatorFeatures': 'uint16[] features\nstring[] spawn_formats\nstring custom_info',
  'simulation_interfaces/msg/SpawnEntity':
    'string name\nbool allow_renaming\nResource entity_resource\nstring entity_namespace\ngeometry_msgs/PoseStamped initial_pose',
  'simulation_interfaces/msg/SpawnResult': 'Result result\nstring entity_name',
  'simulation_interfaces/msg/WorldResource': 'string name\nResource world_resource\nstring description\nstring[] tags',
};

// Request and response of each service.
const kServices = {
  GetSimulatorFeatures: ['', 'SimulatorFeatures features'],
  GetSimulationState: ['', 'SimulationState state\nResult result'],
  SetSimulationState: ['SimulationState state', 'Result result'],
  StepSimulation: ['uint64 steps 1', 'Result result'],
  ResetSimulation: ['uint8 scope', 'Result result'],
  GetEntities: ['EntityFilters filters', 'Result result\nstring[] entities'],
  GetEntitiesStates: ['EntityFilters filters', 'Result result\nstring[] entities\nEntityState[] states'],
  GetEntityState: ['string entity', 'Result result\nEntityState state'],
  SetEntityState: ['string entity\nEntityState state\nbool set_pose\nbool set_twist\nbool set_acceleration', 'Result result'],
  GetEntityInfo: ['string entity', 'Result result\nEntityInfo info'],
  GetEntityBounds: ['string entity', 'Result result\nBounds bounds'],
  SpawnEntity: [kOthers['simulation_interfaces/msg/SpawnEntity'], 'Result result\nstring entity_name'],
  SpawnEntities: ['SpawnEntity[] spawn_requests', 'Result result\nSpawnResult[] results'],
  DeleteEntity: ['string entity', 'Result result'],
  LoadWorld: [
    'Resource world_resource\nbool fail_on_unsupported_element\nbool ignore_missing_or_unsupported_assets',
    'Result result\nWorldResource world',
  ],
  GetCurrentWorld: ['', 'Result result\nWorldResource world'],
};

const short = (name) => name.replace(/\/(msg|srv)\//, '/');
const kBuiltin = { time: 'builtin_interfaces/Time', duration: 'builtin_interfaces/Duration' };

// Members of a definition that are no constants; types of the same package with its name.
function membersOf(name, text) {
  const own = name.split('/')[0];
  // ROS gives a message without members one byte.
  const parsed = parse(text || 'uint8 structure_needs_at_least_one_member', { ros2: true, skipTypeFixup: true });
  return parsed[0].definitions.map((member) => {
    const isLocal = member.isComplex && !member.type.includes('/');
    return { ...member, type: isLocal ? `${own}/${member.type}` : member.type };
  });
}

export const definitions = new Map(); // package/Type -> members
export const fullNames = new Map(); // package/Type -> package/msg/Type
for (const { name, definitions: members } of Object.values(ros2jazzy)) {
  definitions.set(name, members.filter((member) => !member.isConstant));
  fullNames.set(name, name.replace('/', '/msg/'));
}
const add = (full, text) => {
  definitions.set(short(full), membersOf(full, text));
  fullNames.set(short(full), full);
};
for (const [full, text] of Object.entries(kOthers)) add(full, text);
for (const [service, texts] of Object.entries(kServices))
  texts.forEach((text, i) => add(`simulation_interfaces/srv/${service}_${i === 0 ? 'Request' : 'Response'}`, text));
for (const name of Object.values(kBuiltin)) {
  definitions.set(name, [
    { name: 'sec', type: 'int32' },
    { name: 'nanosec', type: 'uint32' },
  ]);
  fullNames.set(name, name.replace('/', '/msg/'));
}

// A definition with all that it refers to, as MessageReader and MessageWriter want it.
export function whole(name) {
  const out = [],
    seen = new Set();
  const visit = (type) => {
    if (seen.has(type)) return;
    seen.add(type);
    const members = definitions.get(type);
    if (!members) throw new Error(`no definition of ${type}`);
    out.push({ name: type, definitions: members });
    for (const member of members) if (member.isComplex) visit(member.type);
  };
  visit(name);
  return out;
}

// ---- Type hashes, as REP-2016 and rosidl_generator_type_description define them: SHA-256 of the type's description as JSON.

const kTypeIds = { int8: 2, uint8: 3, int16: 4, uint16: 5, int32: 6, uint32: 7, int64: 8, uint64: 9, float32: 10, float64: 11, bool: 15, string: 17 };
const kBoundedString = 21,
  kArray = 48,
  kBoundedSequence = 96,
  kSequence = 144;

function fieldOf(member) {
  const nested = kBuiltin[member.type] ?? (member.isComplex ? member.type : undefined);
  let id = nested ? 1 : kTypeIds[member.type];
  if (member.upperBound !== undefined) id = kBoundedString;
  let capacity = 0;
  if (member.isArray) {
    capacity = member.arrayLength ?? member.arrayUpperBound ?? 0;
    id += member.arrayLength !== undefined ? kArray : member.arrayUpperBound !== undefined ? kBoundedSequence : kSequence;
  }
  const type = { type_id: id, capacity, string_capacity: member.upperBound ?? 0, nested_type_name: nested ? fullNames.get(nested) : '' };
  return { name: member.name, type };
}

const describe = (name) => ({ type_name: fullNames.get(name), fields: definitions.get(name).map(fieldOf) });

// JSON with a blank behind each comma and colon, as Python writes it.
function python(value) {
  if (Array.isArray(value)) return `[${value.map(python).join(', ')}]`;
  if (value !== null && typeof value === 'object')
    return `{${Object.entries(value).map(([key, item]) => `${JSON.stringify(key)}: ${python(item)}`).join(', ')}}`;
  return JSON.stringify(value);
}

function referenced(name, seen = new Set()) {
  for (const member of definitions.get(name)) {
    const nested = kBuiltin[member.type] ?? (member.isComplex ? member.type : undefined);
    if (!nested || seen.has(nested)) continue;
    seen.add(nested);
    referenced(nested, seen);
  }
  return seen;
}

export function typeHash(name) {
  const others = [...referenced(name)].map(describe).sort((a, b) => (a.type_name < b.type_name ? -1 : 1));
  const text = python({ type_description: describe(name), referenced_type_descriptions: others });
  return `RIHS01_${createHash('sha256').update(text).digest('hex')}`;
}
