// From bytes to a snapshot.
#include <algorithm>
#include <cmath>
#include <set>

#include "simulation/snapshot/format.h"
#include "simulation/snapshot/format_cells.h"
#include "simulation/snapshot/format_scene.h"
#include "simulation/snapshot/records.h"

namespace plab::simulation
{
namespace
{

using namespace records;

constexpr const char* kSceneSections[] = {"settings", "cameras", "components",   "groups",       "commands",
                                          "fields",   "roles",   "role_members", "role_patterns"};
constexpr const char* kOtherSections[] = {"run",
                                          "clock",
                                          "watch",
                                          "split",
                                          "lives",
                                          "bodies",
                                          "shafts",
                                          "quantities",
                                          "pairs",
                                          "pairs.points",
                                          "parked_pairs",
                                          "parked_pairs.points",
                                          "spring_pairs",
                                          "spring_pairs.points",
                                          "parked_spring_pairs",
                                          "parked_spring_pairs.points",
                                          "rest",
                                          "crowded",
                                          "waiting",
                                          "notes"};

Result<void> refuse_unknown(const std::vector<Section>& sections)
{
    std::set<std::string> seen;
    for (const Section& s : sections)
    {
        if (!seen.insert(s.name).second) return reason("the snapshot's section '" + s.name + "' occurs twice");
        const auto is = [&](const char* name) { return s.name == name || s.name == std::string("loaded.") + name; };
        const bool known =
            std::any_of(std::begin(kSceneSections), std::end(kSceneSections), is) ||
            std::any_of(std::begin(kOtherSections), std::end(kOtherSections), [&](const char* name) { return s.name == name; }) ||
            s.name.starts_with(kCellsPrefix);
        if (!known) return reason("the snapshot's section '" + s.name + "' is unknown to this build");
    }
    return {};
}

/// Builds a snapshot from the sections of a file. Directory indices are rows of the section "components".
///
/// A file may be damaged or made with bad intent, and what is built here is later used without checks. So each part is checked when it is
/// read: numbers of the clock against their ranges, references against the components that exist and their facets, counts against the
/// rows that follow. The parts are read in the order in which they refer to one another: the scene gives the components, the components
/// give the tables, and rows of the tables are what contacts refer to.
class FileReader
{
public:
    FileReader(const std::vector<Section>& sections, model::TypeSource& types)
        : sections_(sections), types_(types), out_(std::make_shared<SnapshotContent>()), directory_(std::make_shared<world::Directory>())
    {
    }

    Result<SnapshotFile> read()
    {
        for (auto part : {&FileReader::read_run, &FileReader::read_scenes, &FileReader::read_directory, &FileReader::read_lives,
                          &FileReader::read_bodies, &FileReader::read_shafts, &FileReader::read_quantities, &FileReader::read_contacts,
                          &FileReader::read_texts})
            if (auto done = (this->*part)(); !done) return done.errors();
        out_->world.directory = directory_;
        file_.snapshot = Snapshot(std::move(out_));
        return std::move(file_);
    }

private:
    const Section& section(const char* name) const { return find_section(sections_, name); }

    template <class T>
    Result<T> single(const char* name) const
    {
        auto rows = rows_of<T>(section(name));
        if (!rows) return rows.errors();
        if (rows->size() != 1) return reason(std::string("the snapshot has no section '") + name + "' of one row");
        return std::move(rows->front());
    }

    Result<void> read_run()
    {
        auto run = single<RunRow>("run");
        if (!run) return run.errors();
        auto clock = single<ClockImage>("clock");
        if (!clock) return clock.errors();
        auto watch = single<Watch>("watch");
        if (!watch) return watch.errors();
        auto split = rows_of<Number>(section("split"));
        if (!split) return split.errors();
        run_ = *run, watch_ = *watch;
        SnapshotContent& s = *out_;
        s.clock = *clock;
        const model::StepLength& dt = s.clock.dt;
        if (!(dt.seconds > 0 && dt.seconds <= 3600) || dt.denominator < 0 || dt.numerator <= 0 || s.clock.tick < 0 ||
            s.clock.base_tick < 0 || s.clock.base_tick > s.clock.tick || !(s.clock.rate >= 0) || s.clock.steps_left < 0)
            return reason("the snapshot's clock is not valid");
        s.run = run->run, s.revision = run->revision, s.state_hash = run->state_hash, s.contacts.next_id = run->next_contact;
        s.ledger.departed = run->departed_work, s.ledger.requests = run->requests_work, s.ledger.kinetic_at_start = run->kinetic_at_start;
        s.reported.stiff = run->reported_stiff, s.reported.stiff_forces = run->reported_stiff_forces;
        for (const Number& n : *split) s.split.push_back(n.value);
        DivergenceMemory& w = s.watch;
        w.counting = watch->counting, w.reported = watch->reported, w.sealed = watch->sealed, w.start_energy = watch->start_energy;
        w.last_kinetic = watch->last_kinetic, w.start_other_work = watch->start_other_work;
        w.gaining_since = watch->gaining_since, w.gaining_steps = watch->gaining_steps;
        file_.build = run->build;
        return {};
    }

    Result<void> read_scenes()
    {
        auto scene = read_scene({}, sections_);
        if (!scene) return scene.errors();
        if (Errors errors = check_scene(*scene, types_); !errors.empty()) return errors;
        auto shared = std::make_shared<const model::SceneSpec>(scene.take());
        out_->world.scene = out_->loaded = shared;
        if (run_.loaded_is_scene) return {};
        auto loaded = read_scene("loaded.", sections_);
        if (!loaded) return loaded.errors();
        if (Errors errors = check_scene(*loaded, types_); !errors.empty()) return errors;
        out_->loaded = std::make_shared<const model::SceneSpec>(loaded.take());
        return {};
    }

    Result<void> read_directory()
    {
        world::Image& image = out_->world;
        for (const model::ComponentSpec& c : image.scene->components)
        {
            world::Component component;
            component.id = c.id, component.alive = true;
            directory_->index_of_id.edit()[c.id] = static_cast<std::uint32_t>(directory_->components.size());
            directory_->components.push_back(std::move(component));
        }
        return read_cells(sections_, types_, *directory_, image);
    }

    Result<void> read_lives()
    {
        auto lives = rows_of<Life>(section("lives"));
        if (!lives) return lives.errors();
        if (lives->size() != directory_->components.size()) return reason("the snapshot's section 'lives' does not fit its components");
        SnapshotContent& s = *out_;
        for (std::size_t i = 0; i < lives->size(); ++i)
        {
            const Life& life = (*lives)[i];
            directory_->components[i].quarantined = life.quarantined;
            s.reported.contradictory.push_back(life.contradictory ? 1 : 0), s.ledger.work.push_back(life.work);
            s.ledger.contact_energy.push_back({life.created, life.by_correction});
            if (!watch_.knows_work) continue;
            s.watch.start_work.push_back(life.start_work), s.watch.start_created.push_back(life.start_created),
                s.watch.passive.push_back(life.passive ? 1 : 0);
        }
        return {};
    }

    /// Assigns the next host row to the component that a row of `section` names.
    Result<void> claim(const char* name, std::uint32_t component, Facet facet, std::size_t row)
    {
        const bool there = component < directory_->components.size() && directory_->components[component].facet == facet &&
                           directory_->components[component].host_index == kNoIndex;
        if (!there)
            return reason(std::string("the snapshot's section '") + name + "', row " + std::to_string(row) + " belongs to no component");
        directory_->components[component].host_index = static_cast<std::uint32_t>(row);
        return {};
    }
    Result<void> none_missing(const char* name, Facet facet) const
    {
        for (const world::Component& c : directory_->components)
            if (c.table != kNoIndex && c.facet == facet && c.host_index == kNoIndex)
                return Error{{}, c.id, std::string("is not in the snapshot's section '") + name + "'"};
        return {};
    }

    Result<void> read_bodies()
    {
        auto bodies = rows_of<records::Body>(section("bodies"));
        if (!bodies) return bodies.errors();
        Bodies& b = out_->world.bodies;
        DivergenceMemory& w = out_->watch;
        for (const records::Body& r : *bodies)
        {
            if (auto done = claim("bodies", r.component, Facet::Body, b.size()); !done) return done;
            b.motion.push_back(r.motion), b.position.push_back(r.position), b.orientation.push_back(r.orientation);
            b.velocity.push_back(r.velocity), b.angular_velocity.push_back(r.angular_velocity);
            b.angular_momentum.push_back(r.angular_momentum), b.mass.push_back(r.mass), b.inverse_mass.push_back(r.inverse_mass);
            b.needle.push_back(r.needle ? 1 : 0), b.inertia_B.push_back(r.inertia), b.inverse_inertia_B.push_back(r.inverse_inertia);
            b.center_B.push_back(r.center);
            if (watch_.knows_bodies)
                w.linear.push_back(r.linear), w.spin.push_back(r.spin), w.bodies_reported.push_back(r.reported ? 1 : 0);
            if (watch_.knows_missed) w.tunnels.reported.push_back(r.reported_missed ? 1 : 0);
            w.tunnels.sinking.push_back(r.sinking);
        }
        return none_missing("bodies", Facet::Body);
    }

    Result<void> read_shafts()
    {
        auto shafts = rows_of<records::Shaft>(section("shafts"));
        if (!shafts) return shafts.errors();
        Shafts& s = out_->world.shafts;
        DivergenceMemory& w = out_->watch;
        for (const records::Shaft& r : *shafts)
        {
            if (auto done = claim("shafts", r.component, Facet::Shaft, s.size()); !done) return done;
            s.motion.push_back(r.motion), s.angle.push_back(r.angle), s.speed.push_back(r.speed);
            s.inertia.push_back(r.inertia), s.inverse_inertia.push_back(r.inverse_inertia);
            s.ratio.push_back(r.ratio), s.anchor.push_back(r.anchor), s.root_anchor.push_back(r.root_anchor);
            if (watch_.knows_shafts) w.turn.push_back(r.turn), w.shafts_reported.push_back(r.reported ? 1 : 0);
        }
        for (const records::Shaft& r : *shafts)
        {
            const bool there = r.root < directory_->components.size() && directory_->components[r.root].facet == Facet::Shaft;
            if (!there) return reason("the snapshot's section 'shafts' names a root that is not a shaft");
            s.root.push_back(directory_->components[r.root].host_index);
        }
        return none_missing("shafts", Facet::Shaft);
    }

    Result<void> read_quantities()
    {
        auto quantities = rows_of<Quantity>(section("quantities"));
        if (!quantities) return quantities.errors();
        auto& values = out_->world.quantities.value;
        for (Quantity& q : *quantities)
        {
            if (auto done = claim("quantities", q.component, Facet::Quantities, values.size()); !done) return done;
            values.push_back(std::move(q.values));
        }
        return none_missing("quantities", Facet::Quantities);
    }

    template <class List, class Head, class Point>
    Result<void> read_pairs(const std::string& name, std::vector<Head> List::*, std::vector<Point> List::*, List& out)
    {
        auto heads = rows_of<Head>(find_section(sections_, name));
        if (!heads) return heads.errors();
        auto points = rows_of<Point>(find_section(sections_, name + ".points"));
        if (!points) return points.errors();
        std::size_t count = 0;
        for (Head& head : *heads)
        {
            const auto& components = directory_->components;
            const auto is = [&](std::uint32_t i, Facet facet)
            { return i < components.size() && components[i].facet == facet && components[i].table != kNoIndex; };
            if (head.count > PairState::kMostContacts || !is(head.detector, Facet::Component) || !is(head.a.index, Facet::Body) ||
                !is(head.b.index, Facet::Body))
                return reason("the snapshot's section '" + name + "' has a pair that is not valid");
            head.a.index = components[head.a.index].host_index, head.b.index = components[head.b.index].host_index;
            count += head.count;
        }
        if (count != points->size()) return reason("the snapshot's section '" + name + "' does not fit its points");
        out.heads = heads.take(), out.points = points.take();
        return {};
    }

    Result<void> read_contacts()
    {
        static_assert(PairState::kMostContacts == ForcePair::kMostContacts);
        using Pairs = ContactsImage::Pairs;
        using Springs = ContactsImage::ForcePairs;
        ContactsImage& c = out_->contacts;
        for (auto& [name, list] : {std::pair<const char*, Pairs*>{"pairs", &c.pairs}, {"parked_pairs", &c.parked}})
            if (auto done = read_pairs(name, &Pairs::heads, &Pairs::points, *list); !done) return done;
        for (auto& [name, list] :
             {std::pair<const char*, Springs*>{"spring_pairs", &c.force_pairs}, {"parked_spring_pairs", &c.parked_force_pairs}})
            if (auto done = read_pairs(name, &Springs::heads, &Springs::points, *list); !done) return done;
        if (auto done = read_rest(); !done) return done;
        return read_crowded();
    }

    /// Whether a row's component is a body.
    bool is_body(std::uint32_t component) const
    {
        const auto& components = directory_->components;
        return component < components.size() && components[component].facet == Facet::Body && components[component].table != kNoIndex;
    }

    Result<void> read_rest()
    {
        auto rows = rows_of<Rest>(section("rest"));
        if (!rows) return rows.errors();
        const auto& components = directory_->components;
        ContactsImage& c = out_->contacts;
        if (!rows->empty()) c.rest.resize(out_->world.bodies.size());
        for (const Rest& row : *rows)
        {
            if (!is_body(row.component)) return reason("the snapshot's section 'rest' has a row that is not valid");
            c.rest[components[row.component].host_index] = row.body, c.rest_cause = row.scene_cause;
        }
        return {};
    }

    Result<void> read_crowded()
    {
        auto rows = rows_of<Crowded>(section("crowded"));
        if (!rows) return rows.errors();
        std::vector<double>& until = out_->contacts.crowded_until;
        if (!rows->empty()) until.assign(out_->world.bodies.size(), -HUGE_VAL);
        for (const Crowded& row : *rows)
        {
            if (!is_body(row.component) || !std::isfinite(row.until))
                return reason("the snapshot's section 'crowded' has a row that is not valid");
            until[directory_->components[row.component].host_index] = row.until;
        }
        return {};
    }

    Result<void> read_texts()
    {
        auto waiting = rows_of<Note>(section("waiting"));
        if (!waiting) return waiting.errors();
        auto notes = rows_of<Note>(section("notes"));
        if (!notes) return notes.errors();
        for (Note& n : *waiting) file_.waiting.push_back(std::move(n.text));
        for (Note& n : *notes) file_.notes.push_back({std::move(n.name), std::move(n.text)});
        return {};
    }

    const std::vector<Section>& sections_;
    model::TypeSource& types_;
    std::shared_ptr<SnapshotContent> out_;
    std::shared_ptr<world::Directory> directory_;
    SnapshotFile file_;
    RunRow run_;
    Watch watch_;
};

}  // namespace

Result<SnapshotFile> decode(std::span<const std::uint8_t> bytes, model::TypeSource& types)
{
    const auto file = read_sections(bytes, kSnapshotFormat);
    if (!file) return file.errors();
    if (auto known = refuse_unknown(file->sections); !known) return known.errors();
    return FileReader(file->sections, types).read();
}

}  // namespace plab::simulation
