#include "control/recording/analysis/tables.h"

#include <algorithm>
#include <array>

#include "control/recording/analysis/contents.h"

namespace plab::analysis
{
namespace
{

constexpr std::string_view kFirstColumns = "run,step,time_s,log_time_s";

template <class Sequence>
auto items(const Sequence& s)
{
    return std::span(s._buffer, s._buffer == nullptr ? 0 : s._length);
}

/// `time`: of the entry in the sample, where it has one of its own.
CsvRow& begin_row(CsvRow& rows, const Entry& entry, std::optional<double> time = {})
{
    const RunPosition place = run_position_of(entry).value_or(RunPosition{});
    if (!time) time = place.time;
    rows.whole(place.run);
    (void)(place.step ? rows.whole(*place.step) : rows.none());
    (void)(time ? rows.real(*time) : rows.none());
    return rows.seconds(entry.log_time);
}

template <class Values>
std::string joined(const Values& values)
{
    std::string out;
    for (const plab_v2_NamedText& v : items(values)) out += (out.empty() ? "" : "; ") + std::string(v.name) + "=" + v.text;
    return out;
}
std::string joined(const dds_sequence_plab_v2_Parameter& values)
{
    std::string out;
    for (const plab_v2_Parameter& v : items(values)) out += (out.empty() ? "" : "; ") + std::string(v.name) + "=" + v.text;
    return out;
}

// ---- States ---------------------------------------------------------------------------------------------------------

constexpr std::string_view kStates =
    "object,kind,position_x_m,position_y_m,position_z_m,orientation_w,orientation_x,orientation_y,orientation_z,"
    "linear_velocity_x_m_per_s,linear_velocity_y_m_per_s,linear_velocity_z_m_per_s,"
    "angular_velocity_x_rad_per_s,angular_velocity_y_rad_per_s,angular_velocity_z_rad_per_s,angle_rad,speed_rad_per_s";

void add_states(const Entry& entry, const Things& things, CsvRow& rows)
{
    constexpr int kBodyCells = 13, kShaftCells = 2;
    const auto* frame = entry.as<plab_v2_Frame>();
    if (frame == nullptr) return;
    for (const plab_v2_BodyState& b : items(frame->bodies))
    {
        begin_row(rows, entry).text(things.name_of(frame->run, b.handle)).text("body");
        rows.vector(b.position).rotation(b.orientation).vector(b.linear_velocity).vector(b.angular_velocity).none(kShaftCells).end();
    }
    for (const plab_v2_ShaftState& s : items(frame->shafts))
    {
        begin_row(rows, entry).text(things.name_of(frame->run, s.handle)).text("shaft");
        rows.none(kBodyCells).real(s.angle).real(s.speed).end();
    }
}

// ---- What happens ---------------------------------------------------------------------------------------------------

constexpr std::string_view kCollisions =
    "number,kind,detector,a,b,position_x_m,position_y_m,position_z_m,normal_x,normal_y,normal_z,"
    "impulse_x_N_s,impulse_y_N_s,impulse_z_N_s,depth_m";

void add_collisions(const Entry& entry, const Things&, CsvRow& rows)
{
    const auto* collisions = entry.as<plab_v2_Collisions>();
    if (collisions == nullptr) return;
    std::uint64_t number = collisions->sequence_number;
    for (const plab_v2_CollisionInfo& c : items(collisions->entries))
    {
        begin_row(rows, entry, c.time).whole(number++).text(c.kind).text(c.detector).text(c.a).text(c.b);
        rows.vector(c.position).vector(c.normal).vector(c.impulse).real(c.depth).end();
    }
}

constexpr std::string_view kEvents = "number,kind,severity,component,a,b,message,values";

void add_events(const Entry& entry, const Things&, CsvRow& rows)
{
    const auto* events = entry.as<plab_v2_Events>();
    if (events == nullptr) return;
    std::uint64_t number = events->sequence_number;
    for (const plab_v2_EventInfo& e : items(events->entries))
    {
        CsvRow values;
        for (const double v : items(e.values)) values.real(v);
        std::string list = values.take();
        std::replace(list.begin(), list.end(), ',', ' ');
        begin_row(rows, entry, e.time).whole(number++).text(e.kind).text(e.severity).text(e.component_id).text(e.a).text(e.b);
        rows.text(e.message).text(list).end();
    }
}

// ---- Metrics --------------------------------------------------------------------------------------------------------

constexpr std::string_view kMetrics =
    "interaction,requested,resolved,cost_ns,error,work_J,quarantined,outputs,"
    "step_ns,real_time_factor,kinetic_J,stored_J,total_work_J,of_requests_J,unexplained_J,"
    "momentum_x_N_s,momentum_y_N_s,momentum_z_N_s,angular_momentum_x_N_m_s,angular_momentum_y_N_m_s,angular_momentum_z_N_m_s,"
    "residual_m_per_s,deepest_m,contacts";

/// The scene's own row has no interaction; those of the interactions follow it.
void add_metrics(const Entry& entry, const Things&, CsvRow& rows)
{
    constexpr int kOfInteraction = 8, kOfScene = 16;
    const auto* m = entry.as<plab_v2_Metrics>();
    if (m == nullptr) return;
    begin_row(rows, entry).none(kOfInteraction).real(m->step_ns).real(m->real_time_factor).real(m->ledger.kinetic).real(m->ledger.stored);
    rows.real(m->ledger.work).real(m->ledger.of_requests).real(m->ledger.unexplained).vector(m->momentum).vector(m->angular_momentum);
    rows.real(m->residual).real(m->deepest).whole(m->contacts).end();
    for (const plab_v2_InteractionMetrics& i : items(m->interactions))
    {
        begin_row(rows, entry).text(i.component_id).text(i.requested).text(i.resolved).real(i.cost_ns).real(i.error).real(i.work);
        rows.whole(i.quarantined ? 1 : 0).text(joined(i.outputs)).none(kOfScene).end();
    }
}

constexpr std::string_view kServer =
    "server,paused,rate_asked,rate_reached,slipped_s,overload,states_per_second,requests_done,requests_refused,"
    "last_event,last_collision";

void add_server(const Entry& entry, const Things&, CsvRow& rows)
{
    const auto* s = entry.as<plab_v2_Server>();
    if (s == nullptr) return;
    begin_row(rows, entry).text(s->name).whole(s->paused ? 1 : 0).real(s->rate_asked).real(s->rate_reached).real(s->slipped);
    rows.text(s->overload).real(s->states_per_second).whole(s->requests_done).whole(s->requests_refused);
    rows.whole(s->last_event).whole(s->last_collision).end();
}

// ---- Catalogue ------------------------------------------------------------------------------------------------------

constexpr std::string_view kObjects =
    "object,name,type,kind,motion,mass_kg_or_kg_m2,handle,position_x_m,position_y_m,position_z_m,"
    "orientation_w,orientation_x,orientation_y,orientation_z,quarantined,parameters";

void add_objects(const Entry& entry, const Things&, CsvRow& rows)
{
    const auto* o = entry.as<plab_v2_SceneObject>();
    if (o == nullptr) return;
    begin_row(rows, entry).text(o->component_id).text(o->name).text(o->type_name).text(o->shape_of).text(o->motion).real(o->mass);
    rows.whole(o->handle).vector(o->position).rotation(o->orientation).whole(o->quarantined ? 1 : 0).text(joined(o->parameters)).end();
}

constexpr std::string_view kInteractions = "interaction,name,type,family,since_step,participants,quarantined,parameters";

void add_interactions(const Entry& entry, const Things&, CsvRow& rows)
{
    const auto* i = entry.as<plab_v2_Interaction>();
    if (i == nullptr) return;
    std::string participants;
    for (const plab_v2_Participants& p : items(i->roles))
        for (const char* member : items(p.members)) participants += (participants.empty() ? "" : "; ") + std::string(p.role) + "=" + member;
    begin_row(rows, entry).text(i->component_id).text(i->name).text(i->type_name).text(i->family).whole(i->since);
    rows.text(participants).whole(i->quarantined ? 1 : 0).text(joined(i->parameters)).end();
}

// ---- What a replay needs --------------------------------------------------------------------------------------------

constexpr std::string_view kJournal = "number,origin,client,request,verb,target,argument,values";

void add_journal(const Entry& entry, const Things&, CsvRow& rows)
{
    const auto* j = entry.as<plab_v2_Journal>();
    if (j == nullptr) return;
    std::string client;
    for (const std::uint8_t byte : j->client) client += "0123456789abcdef"[byte >> 4], client += "0123456789abcdef"[byte & 15];
    for (const plab_v2_Operation& o : items(j->operations))
    {
        begin_row(rows, entry).whole(j->sequence_number).text(j->origin).text(client).whole(j->number);
        rows.text(o.verb).text(o.target).text(o.argument).text(joined(o.values)).end();
    }
}

void add_hashes(const Entry& entry, const Things&, CsvRow& rows)
{
    const auto* h = entry.as<plab_v2_Hashes>();
    if (h == nullptr) return;
    std::int64_t step = h->step;
    for (const std::uint64_t hash : items(h->values))
        rows.whole(h->run).whole(step++).none().seconds(entry.log_time).hexadecimal(hash).end();
}

constexpr std::string_view kSnapshots = "name,cause,state_hash,data_bytes,blueprint_bytes";

void add_snapshots(const Entry& entry, const Things&, CsvRow& rows)
{
    const auto* s = entry.as<plab_v2_Snapshot>();
    if (s == nullptr) return;
    begin_row(rows, entry).text(s->name).text(s->cause).hexadecimal(s->state_hash).whole(s->data._length);
    rows.whole(std::string_view(s->blueprint).size()).end();
}

constexpr std::array<Table, 10> kTables{{
    {"plab/states", kStates, add_states},
    {"plab/collisions", kCollisions, add_collisions},
    {"plab/events", kEvents, add_events},
    {"plab/metrics", kMetrics, add_metrics},
    {"plab/server", kServer, add_server},
    {"plab/objects", kObjects, add_objects},
    {"plab/interactions", kInteractions, add_interactions},
    {"plab/journal", kJournal, add_journal},
    {"plab/hashes", "state_hash", add_hashes},
    {"plab/snapshots", kSnapshots, add_snapshots},
}};

}  // namespace

std::span<const Table> tables() { return kTables; }

const Table* find_table(std::string_view topic)
{
    const auto found = std::find_if(kTables.begin(), kTables.end(), [&](const Table& t) { return t.topic == topic; });
    return found == kTables.end() ? nullptr : &*found;
}

std::string head_of(const Table& table) { return std::string(kFirstColumns) + "," + std::string(table.columns) + "\n"; }

}  // namespace plab::analysis
