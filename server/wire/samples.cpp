#include "wire/samples.h"

#include <algorithm>
#include <utility>

#include "simulation/requests/request_words.h"
#include "wire/wire_view.h"

namespace plab::wire
{
namespace
{

const char* word(Motion motion)
{
    switch (motion)
    {
        case Motion::Static:
            return "static";
        case Motion::Kinematic:
            return "kinematic";
        case Motion::Dynamic:
            return "dynamic";
    }
    return "";
}

const char* word(GeometryKind kind)
{
    switch (kind)
    {
        case GeometryKind::None:
            return "none";
        case GeometryKind::Sphere:
            return "sphere";
        case GeometryKind::Box:
            return "box";
        case GeometryKind::Plane:
            return "plane";
        case GeometryKind::Mesh:
            return "mesh";
        case GeometryKind::Capsule:
            return "capsule";
        case GeometryKind::Cylinder:
            return "cylinder";
        case GeometryKind::Compound:
            return "compound";
    }
    return "";
}

const char* word(Severity severity)
{
    switch (severity)
    {
        case Severity::Info:
            return "info";
        case Severity::Warning:
            return "warning";
        case Severity::Failure:
            return "failure";
    }
    return "";
}

/// Fills `out` with one wire element per record; `out` keeps its memory from sample to sample.
template <class Wire, class Record, class Convert>
void convert_each(std::vector<Wire>& out, const std::vector<Record>& records, Convert&& convert)
{
    out.clear();
    out.reserve(records.size());
    for (const Record& record : records) out.push_back(convert(record));
}

void convert_texts(std::vector<char*>& out, const std::vector<std::string>& texts)
{
    convert_each(out, texts, [](const std::string& s) { return text(s); });
}

void convert_parameters(std::vector<plab_v2_Parameter>& out, const std::vector<publish::Parameter>& parameters)
{
    convert_each(out, parameters,
                 [](const publish::Parameter& p) {
                     return plab_v2_Parameter{text(p.name), text(p.text), text(p.unit), text(p.kind)};
                 });
}

plab_v2_StepOutcome outcome(const simulation::StepOutcome& o) { return {o.energy, vector(o.momentum), o.error, o.cost_ns}; }

}  // namespace

const plab_v2_Server& ServerSample::of(const Identity& identity, const publish::Status& status, std::span<const Dropped> dropped)
{
    dropped_.clear();
    for (const Dropped& d : dropped) dropped_.push_back({text(d.topic), d.samples});
    wire_.name = text(identity.name), wire_.version = text(identity.version), wire_.host = text(identity.host);
    wire_.process = identity.process, wire_.started_ns = identity.started_ns;
    wire_.scene_file = text(status.scene_file);
    wire_.run = status.run, wire_.revision = status.revision, wire_.step = status.step;
    wire_.time = status.time, wire_.dt = status.dt, wire_.paused = status.paused;
    wire_.rate_asked = status.rate_asked, wire_.rate_reached = status.rate_reached, wire_.slipped = status.slipped;
    wire_.overload = text(!status.busy.empty() ? status.busy.c_str() : status.slipping ? "slip" : "");
    wire_.states_per_second = status.states_per_second, wire_.threads = status.threads;
    wire_.last_event = status.last_event, wire_.last_collision = status.last_collision;
    wire_.requests_done = status.requests_done, wire_.requests_refused = status.requests_refused;
    view(wire_.dropped, dropped_);
    convert_each(snapshots_, status.snapshots,
                 [](const publish::KeptSnapshot& k) {
                     return plab_v2_KeptSnapshot{text(k.name), k.run, k.step, k.time, k.bytes};
                 });
    view(wire_.snapshots, snapshots_);
    const publish::RecordingStatus& r = status.recording;
    wire_.playback = text(""), wire_.rewind_from = status.rewind_from;
    wire_.recording = {text(r.file), r.bytes, r.messages, r.dropped, text(r.trouble)};
    return wire_;
}

const plab_v2_Scene& SceneSample::of(const std::string& server, const publish::SceneEntry& scene)
{
    convert_each(cameras_, scene.cameras,
                 [](const model::Camera& c) {
                     return plab_v2_View{text(c.name), vector(c.position), vector(c.look_at), vector(c.up), c.field_of_view};
                 });
    wire_.server_name = text(server), wire_.run = scene.run, wire_.file = text(scene.file), wire_.title = text(scene.title);
    wire_.dt = scene.dt, wire_.seed = scene.seed, wire_.objects = scene.objects, wire_.interactions = scene.interactions;
    view(wire_.cameras, cameras_);
    return wire_;
}

const plab_v2_SceneObject& ObjectSample::of(const publish::ObjectEntry& object)
{
    convert_texts(shapes_, object.shapes);
    convert_parameters(parameters_, object.parameters);
    wire_.component_id = text(object.component), wire_.name = text(object.name), wire_.type_name = text(object.type);
    wire_.handle = object.handle, wire_.run = object.run;
    wire_.shape_of = text(object.is_shaft ? "shaft" : "body"), wire_.motion = text(word(object.motion));
    wire_.mass = object.mass, wire_.position = vector(object.pose.p), wire_.orientation = rotation(object.pose.q);
    wire_.color = vector(object.color), wire_.quarantined = object.quarantined;
    view(wire_.shapes, shapes_);
    view(wire_.parameters, parameters_);
    return wire_;
}

const plab_v2_Shape& ShapeSample::of(const publish::ShapeEntry& shape)
{
    const Geometry& g = shape.geometry;
    wire_.component_id = text(shape.component), wire_.type_name = text(shape.type), wire_.form = text(word(g.kind));
    wire_.position = vector(g.pose.p), wire_.orientation = rotation(g.pose.q), wire_.size = vector(g.size);
    view(wire_.vertices, g.vertices);
    view(wire_.triangles, g.triangles);
    return wire_;
}

const plab_v2_Interaction& InteractionSample::of(const publish::InteractionEntry& interaction)
{
    members_.resize(std::max(members_.size(), interaction.roles.size()));
    roles_.clear();
    for (std::size_t i = 0; i < interaction.roles.size(); ++i)
    {
        convert_texts(members_[i], interaction.roles[i].members);
        view(roles_.emplace_back(plab_v2_Participants{text(interaction.roles[i].role), {}}).members, members_[i]);
    }
    convert_parameters(parameters_, interaction.parameters);
    wire_.component_id = text(interaction.component), wire_.name = text(interaction.name);
    wire_.type_name = text(interaction.type), wire_.family = text(interaction.family);
    wire_.run = interaction.run, wire_.since = interaction.since, wire_.quarantined = interaction.quarantined;
    view(wire_.roles, roles_);
    view(wire_.parameters, parameters_);
    return wire_;
}

const plab_v2_Type& TypeSample::of(const model::TypeSummary& type)
{
    convert_each(roles_, type.roles,
                 [](const model::RoleSummary& r) {
                     return plab_v2_RoleInfo{text(r.name), text(r.accepts), r.least, r.most, text(r.doc)};
                 });
    convert_each(fields_, type.fields,
                 [](const model::FieldSummary& f)
                 {
                     return plab_v2_FieldInfo{text(f.name),     text(f.kind), text(f.value_type), text(f.unit),
                                              text(f.fallback), f.required,   text(f.rule),       text(f.doc)};
                 });
    wire_.type_name = text(type.name), wire_.family = text(type.family), wire_.doc = text(type.doc);
    wire_.plugin = text(type.plugin), wire_.is_loaded = type.loaded, wire_.order = type.order;
    wire_.accuracy = text(type.accuracy), wire_.strengths = text(type.strengths);
    wire_.cost = text(type.cost), wire_.limits = text(type.limits), wire_.source = text(type.source);
    view(wire_.roles, roles_);
    view(wire_.fields, fields_);
    return wire_;
}

const plab_v2_Frame& FrameSample::of(const publish::Frame& frame)
{
    wire_.run = frame.run, wire_.revision = frame.revision, wire_.sequence_number = frame.number;
    wire_.step = frame.step, wire_.time = frame.time, wire_.stamp_ns = frame.stamp_ns;
    view(wire_.bodies, frame.bodies);
    view(wire_.shafts, frame.shafts);
    return wire_;
}

const plab_v2_Collisions& CollisionsSample::of(const publish::Batch<publish::CollisionRecord>& batch)
{
    convert_each(entries_, batch.entries,
                 [](const publish::CollisionRecord& c)
                 {
                     return plab_v2_CollisionInfo{text(c.kind),       c.time,           text(c.detector),  text(c.a), text(c.b),
                                                  vector(c.position), vector(c.normal), vector(c.impulse), c.depth};
                 });
    wire_.run = batch.run, wire_.sequence_number = batch.first, wire_.step = batch.step;
    view(wire_.entries, entries_);
    return wire_;
}

const plab_v2_Events& EventsSample::of(const publish::Batch<publish::EventRecord>& batch)
{
    convert_each(entries_, batch.entries,
                 [](const publish::EventRecord& e)
                 {
                     plab_v2_EventInfo info{text(e.kind), text(word(e.severity)), e.time, text(e.component), text(e.a),
                                            text(e.b),    text(e.message),        {}};
                     view(info.values, e.values);
                     return info;
                 });
    wire_.run = batch.run, wire_.sequence_number = batch.first, wire_.step = batch.step;
    view(wire_.entries, entries_);
    return wire_;
}

const plab_v2_Metrics& MetricsSample::of(const publish::Metrics& metrics)
{
    outputs_.resize(std::max(outputs_.size(), metrics.interactions.size()));
    interactions_.clear();
    for (std::size_t i = 0; i < metrics.interactions.size(); ++i)
    {
        const publish::InteractionMetrics& m = metrics.interactions[i];
        convert_parameters(outputs_[i], m.outputs);
        interactions_.push_back({text(m.component), text(m.requested), text(m.resolved), m.cost_ns, m.error, m.work, m.quarantined, {}});
        view(interactions_.back().outputs, outputs_[i]);
    }
    wire_.run = metrics.run, wire_.revision = metrics.revision, wire_.step = metrics.step, wire_.time = metrics.time;
    wire_.step_ns = metrics.step_ns, wire_.real_time_factor = metrics.real_time_factor;
    wire_.ledger = {metrics.kinetic, metrics.stored, metrics.work, metrics.of_requests, metrics.unexplained};
    wire_.momentum = vector(metrics.momentum), wire_.angular_momentum = vector(metrics.angular_momentum);
    wire_.residual = metrics.residual, wire_.deepest = metrics.deepest, wire_.contacts = metrics.contacts;
    view(wire_.interactions, interactions_);
    return wire_;
}

const plab_v2_Image& ImageSample::of(const publish::Image& image)
{
    wire_.camera = text(image.camera), wire_.run = image.run, wire_.step = image.step, wire_.time = image.time;
    wire_.width = image.width, wire_.height = image.height, wire_.encoding = text("rgba8");
    view(wire_.data, image.rgba);
    return wire_;
}

const plab_v2_Journal& JournalSample::of(const publish::JournalRecord& entry)
{
    values_.resize(std::max(values_.size(), entry.operations.size()));
    operations_.clear();
    for (std::size_t i = 0; i < entry.operations.size(); ++i)
    {
        const publish::OperationText& op = entry.operations[i];
        convert_each(values_[i], op.values, [](const auto& v) { return plab_v2_NamedText{text(v.first), text(v.second)}; });
        operations_.push_back({text(op.verb), text(op.target), text(op.argument), text(op.blueprint), {}});
        view(operations_.back().values, values_[i]);
    }
    wire_.run = entry.run, wire_.revision = entry.revision, wire_.sequence_number = entry.number;
    wire_.step = entry.step, wire_.time = entry.time, wire_.origin = text(entry.origin), wire_.number = entry.request;
    std::copy(entry.client.begin(), entry.client.end(), wire_.client);
    view(wire_.operations, operations_);
    return wire_;
}

const plab_v2_Hashes& HashesSample::of(const publish::HashRecord& record)
{
    wire_.run = record.run, wire_.sequence_number = record.first, wire_.step = record.step;
    view(wire_.values, record.hashes);
    return wire_;
}

const plab_v2_Snapshot& SnapshotSample::of(const publish::SnapshotRecord& snapshot)
{
    wire_.run = snapshot.run, wire_.revision = snapshot.revision, wire_.step = snapshot.step, wire_.time = snapshot.time;
    wire_.name = text(snapshot.name), wire_.cause = text(snapshot.cause), wire_.state_hash = snapshot.state_hash;
    wire_.blueprint = text(snapshot.blueprint);
    view(wire_.data, snapshot.data);
    return wire_;
}

const plab_v2_Reply& ReplySample::of(const publish::Answer& answer, bool repeated)
{
    const simulation::Reply& r = answer.reply;
    convert_each(texts_, r.errors, [](const Error& e) { return e.text(); });
    convert_texts(reasons_, texts_);
    fields_.resize(std::max(fields_.size(), r.swaps.size()));
    swaps_.clear();
    for (std::size_t i = 0; i < r.swaps.size(); ++i)
    {
        const simulation::SwapReport& s = r.swaps[i];
        convert_each(fields_[i], s.fields,
                     [](const simulation::TransferredField& f) {
                         return plab_v2_FieldFate{text(f.field), text(simulation::name_of(f.transfer))};
                     });
        swaps_.push_back({text(s.id), text(s.from), text(s.to), {}, s.energy_before, outcome(s.with_old), outcome(s.with_new)});
        view(swaps_.back().fields, fields_[i]);
    }
    std::copy(answer.client.begin(), answer.client.end(), wire_.client);
    wire_.number = answer.number, wire_.outcome = text(r.done ? "done" : r.late ? "late" : "refused"), wire_.repeated = repeated;
    wire_.run = answer.run, wire_.revision = r.revision, wire_.step = r.step, wire_.time = answer.time;
    wire_.pause_ns = r.pause_ns, wire_.waited_ns = answer.waited_ns;
    trial_ = simulation::text_of(r.trial);
    wire_.trial = text(trial_);
    view(wire_.reasons, reasons_);
    view(wire_.swaps, swaps_);
    return wire_;
}

}  // namespace plab::wire
