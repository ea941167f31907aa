// From a snapshot to bytes.
#include <cmath>
#include <map>

#include "simulation/snapshot/build.h"
#include "simulation/snapshot/format.h"
#include "simulation/snapshot/format_cells.h"
#include "simulation/snapshot/format_scene.h"
#include "simulation/snapshot/records.h"

namespace plab::simulation
{
namespace
{

using namespace records;

/// Maps indices in memory to rows of the section "components".
class FileRows
{
public:
    explicit FileRows(const world::Image& image)
        : of_component_(image.directory->components.size(), kNoIndex),
          of_body_(image.bodies.size(), kNoIndex),
          of_shaft_(image.shafts.size(), kNoIndex)
    {
        const auto& specs = image.scene->components;
        const auto& index = *image.directory->index_of_id;
        for (std::uint32_t row = 0; row < specs.size(); ++row)
            if (const auto at = index.find(specs[row].id); at != index.end()) of_component_[at->second] = row;
        image.for_each(
            [&](std::uint32_t i, const world::Component& c, const world::Layout&)
            {
                if (c.facet == Facet::Body) of_body_[c.host_index] = of_component_[i];
                if (c.facet == Facet::Shaft) of_shaft_[c.host_index] = of_component_[i];
            });
    }
    std::uint32_t component(std::uint32_t i) const { return i < of_component_.size() ? of_component_[i] : kNoIndex; }
    std::uint32_t shaft(std::uint32_t i) const { return i < of_shaft_.size() ? of_shaft_[i] : kNoIndex; }
    Ref body(Ref r) const { return {Facet::Body, r.index < of_body_.size() ? of_body_[r.index] : kNoIndex}; }

private:
    std::vector<std::uint32_t> of_component_, of_body_, of_shaft_;
};

template <class T>
T at_or_default(const std::vector<T>& list, std::uint32_t i)
{
    return i < list.size() ? list[i] : T{};
}

records::Body body_record(const SnapshotContent& s, std::uint32_t component, std::uint32_t i)
{
    const Bodies& b = s.world.bodies;
    records::Body out;
    out.component = component, out.motion = b.motion[i], out.position = b.position[i], out.orientation = b.orientation[i];
    out.velocity = b.velocity[i], out.angular_velocity = b.angular_velocity[i], out.angular_momentum = b.angular_momentum[i];
    out.mass = b.mass[i], out.inverse_mass = b.inverse_mass[i], out.needle = b.needle[i] != 0;
    out.inertia = b.inertia_B[i], out.inverse_inertia = b.inverse_inertia_B[i], out.center = b.center_B[i];
    out.linear = at_or_default(s.watch.linear, i), out.spin = at_or_default(s.watch.spin, i);
    out.reported = at_or_default(s.watch.bodies_reported, i) != 0, out.reported_missed = at_or_default(s.watch.tunnels.reported, i) != 0;
    out.sinking = at_or_default(s.watch.tunnels.sinking, i);
    return out;
}

records::Shaft shaft_record(const SnapshotContent& s, std::uint32_t component, std::uint32_t i, const FileRows& rows)
{
    const Shafts& h = s.world.shafts;
    records::Shaft out;
    out.component = component, out.motion = h.motion[i], out.angle = h.angle[i], out.speed = h.speed[i];
    out.inertia = h.inertia[i], out.inverse_inertia = h.inverse_inertia[i], out.root = rows.shaft(h.root[i]);
    out.ratio = h.ratio[i], out.anchor = h.anchor[i], out.root_anchor = h.root_anchor[i];
    out.turn = at_or_default(s.watch.turn, i), out.reported = at_or_default(s.watch.shafts_reported, i) != 0;
    return out;
}

void write_components(const SnapshotContent& s, const FileRows& rows, std::vector<Section>& out)
{
    std::vector<Life> lives(s.world.scene->components.size());
    std::vector<records::Body> bodies;
    std::vector<records::Shaft> shafts;
    std::vector<Quantity> quantities;
    for (std::uint32_t i = 0; i < s.world.directory->components.size(); ++i)
    {
        const std::uint32_t row = rows.component(i);
        if (row == kNoIndex) continue;
        lives[row] = {s.world.component(i).quarantined,        at_or_default(s.reported.contradictory, i) != 0,
                      at_or_default(s.watch.passive, i) != 0,  at_or_default(s.ledger.work, i),
                      at_or_default(s.watch.start_work, i),    at_or_default(s.ledger.contact_energy, i).created,
                      at_or_default(s.watch.start_created, i), at_or_default(s.ledger.contact_energy, i).by_correction};
    }
    s.world.for_each(
        [&](std::uint32_t i, const world::Component& c, const world::Layout&)
        {
            const std::uint32_t row = rows.component(i);
            if (c.facet == Facet::Body) bodies.push_back(body_record(s, row, c.host_index));
            if (c.facet == Facet::Shaft) shafts.push_back(shaft_record(s, row, c.host_index, rows));
            if (c.facet == Facet::Quantities) quantities.push_back({row, s.world.quantities.value[c.host_index]});
        });
    out.push_back(section_of("lives", lives)), out.push_back(section_of("bodies", bodies));
    out.push_back(section_of("shafts", shafts)), out.push_back(section_of("quantities", quantities));
}

template <class List>
void write_pairs(const std::string& name, List list, const FileRows& rows, std::vector<Section>& out)
{
    for (auto& head : list.heads) head.detector = rows.component(head.detector), head.a = rows.body(head.a), head.b = rows.body(head.b);
    out.push_back(section_of(name, list.heads)), out.push_back(section_of(name + ".points", list.points));
}

void write_run(const SnapshotContent& s, bool loaded_is_scene, std::vector<Section>& out)
{
    std::vector<RunRow> run{{build_name(), s.run, s.revision, s.state_hash, s.contacts.next_id, s.ledger.departed, s.ledger.requests,
                             s.ledger.kinetic_at_start, s.reported.stiff, s.reported.stiff_forces, loaded_is_scene}};
    std::vector<ClockImage> clock{s.clock};
    std::vector<Number> split;
    for (const std::uint32_t n : s.split) split.push_back({n});
    const DivergenceMemory& w = s.watch;
    std::vector<Watch> watch{{w.counting, w.reported, w.sealed, w.start_energy, w.last_kinetic, w.start_other_work, w.gaining_since,
                              w.gaining_steps, !w.linear.empty(), !w.turn.empty(), !w.start_work.empty(), !w.tunnels.reported.empty()}};
    out.push_back(section_of("run", run)), out.push_back(section_of("clock", clock));
    out.push_back(section_of("watch", watch)), out.push_back(section_of("split", split));
}

}  // namespace

Result<std::vector<std::uint8_t>> encode(const Snapshot& snapshot, std::span<const std::string> waiting,
                                         std::span<const SnapshotNote> notes)
{
    if (!snapshot) return reason("there is no snapshot to write");
    const SnapshotContent& s = *snapshot;
    if (waiting.size() != s.waiting.size())
        return reason(std::to_string(s.waiting.size()) + " requests wait in the snapshot, but there are texts for " +
                      std::to_string(waiting.size()));
    std::vector<Section> sections;
    const std::vector<Section> loaded = write_scene({}, *s.loaded), scene = write_scene({}, *s.world.scene);
    const bool same = write_sections(kSnapshotFormat, loaded) == write_sections(kSnapshotFormat, scene);
    write_run(s, same, sections);
    sections.insert(sections.end(), scene.begin(), scene.end());
    if (!same)
        for (Section& section : write_scene("loaded.", *s.loaded)) sections.push_back(std::move(section));

    const FileRows rows(s.world);
    write_components(s, rows, sections);
    for (Section& section : write_cells(s.world)) sections.push_back(std::move(section));
    write_pairs("pairs", s.contacts.pairs, rows, sections), write_pairs("parked_pairs", s.contacts.parked, rows, sections);
    write_pairs("spring_pairs", s.contacts.force_pairs, rows, sections);
    write_pairs("parked_spring_pairs", s.contacts.parked_force_pairs, rows, sections);

    std::vector<Rest> rest;
    for (std::uint32_t b = 0; b < s.contacts.rest.size(); ++b)
        if (const BodyRest& r = s.contacts.rest[b]; !(r == BodyRest{}))
            rest.push_back({rows.body({Facet::Body, b}).index, r, s.contacts.rest_cause});
    if (!rest.empty()) sections.push_back(section_of("rest", rest));
    std::vector<Crowded> crowded;
    for (std::uint32_t b = 0; b < s.contacts.crowded_until.size(); ++b)
        if (const double until = s.contacts.crowded_until[b]; std::isfinite(until))
            crowded.push_back({rows.body({Facet::Body, b}).index, until});
    if (!crowded.empty()) sections.push_back(section_of("crowded", crowded));

    std::vector<Note> texts, all;
    for (const std::string& text : waiting) texts.push_back({{}, text});
    for (const SnapshotNote& note : notes) all.push_back({note.name, note.text});
    sections.push_back(section_of("waiting", texts)), sections.push_back(section_of("notes", all));
    return write_sections(kSnapshotFormat, sections);
}

}  // namespace plab::simulation
