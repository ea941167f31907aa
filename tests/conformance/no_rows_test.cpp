// A command that is called without rows does nothing: no row, no effect, no crash.
#include "subjects.h"
#include "world/host_tables.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// Counts what commands do to the host. Each stands for an empty scene.
struct Recorder final : ShaftMotion, RatioGraph, RowSink, ContactSink, EventSink
{
    int calls = 0;

    void begin(std::uint32_t, Ref) override { ++calls; }
    void begin(std::uint32_t) override { ++calls; }
    void add(const ConstraintRow&) override { ++calls; }
    double rate(Ref) const override { return 0; }
    double mobility(Ref) const override { return 1; }
    void apply(Ref, double) override { ++calls; }
    void assign(Ref, double) override { ++calls; }
    void add(std::uint32_t, Ref, Ref, const Ratio&) override { ++calls; }
    std::span<const PersistentPair> persistent() const override { return {}; }
    void add(const Contact&) override { ++calls; }
    bool precedes(Ref, Ref) const override { return false; }
    void emit(Event) override { ++calls; }
};

struct NoReactions final : ShaftReactions
{
    std::optional<double> torque(std::uint32_t) const override { return {}; }
};

/// A group in which no object moves.
struct EmptySystem final : DynamicSystem
{
    std::span<double> coordinates() override { return {}; }
    std::span<double> speeds() override { return {}; }
    std::span<const double> coordinate_rates() const override { return {}; }
    std::span<const double> speed_rates() const override { return {}; }
    void evaluate(double, double) override {}
    void evaluate_kinematics() override {}
    std::span<double> workspace(int) override { return {}; }
    std::size_t body_count() const override { return 0; }
    RigidMember rigid(std::size_t) const override { return {}; }
    std::size_t quantity_count() const override { return 0; }
    bool forces_are_uniform() const override { return true; }
    bool is_constrained() const override { return false; }
};

struct NoReports final : RowReports
{
    RowReport of(std::uint32_t) const override { return {}; }
};

/// All that a command may ask for, with two bodies, two shafts and two shapes that it must leave alone.
struct Host
{
    Host()
    {
        for (std::uint32_t i = 0; i < 2; ++i)
            for (const Facet facet : {Facet::Body, Facet::Shaft, Facet::Shape}) tables.add(facet, i);
        wrenches.bind(tables.bodies, tables.shafts);
        wrenches.force.resize(2), wrenches.torque.resize(2), wrenches.shaft_torque.resize(2);
        context.dt = 0.01, context.events = &recorder, context.changes = &changes;
        call.context = &context;
        call.bodies = &tables.bodies, call.shafts = &tables.shafts, call.shapes = &tables.shapes;
        call.materials = &tables.materials, call.filter = &tables.filter, call.wrenches = &wrenches;
        call.shaft_motion = &recorder, call.ratios = &recorder, call.contacts = &recorder;
        call.reactions = &reactions, call.system = &system;
        call.quantities = &tables.quantities, call.rows_out = &recorder, call.row_reports = &reports;
        call.island = &island, call.gap = &gap;
        call.trial = &trial, call.impact = &impact, call.solid = &solid, call.stored = &stored;
    }
    /// State of all rows, as a hash would see it.
    std::vector<std::uint8_t> state() const
    {
        ByteWriter out;
        for (std::uint32_t i = 0; i < 2; ++i)
            for (const Facet facet : {Facet::Body, Facet::Shaft}) world::save_state(tables, {facet, i}, out);
        for (std::uint32_t i = 0; i < 2; ++i)
        {
            write(out, wrenches.force[i]), write(out, wrenches.torque[i]), write(out, wrenches.shaft_torque[i]);
            write(out, tables.shapes.geometry[i].kind), write(out, tables.bodies.mass[i]);
            write(out, tables.shafts.inertia[i]);
        }
        write(out, stored.joule), write(out, solid.mass);
        return out.bytes();
    }

    world::HostTables tables;
    Wrenches wrenches;
    Recorder recorder;
    NoReactions reactions;
    EmptySystem system;
    std::vector<ParameterChange> changes;
    NoReports reports;
    EventBracket trial;
    Island island;
    GapQuery gap;
    Impact impact;
    MassProperties solid;
    StoredEnergy stored;
    StepContext context;
    PhaseCall call;
};

}  // namespace

TEST_CASE("every command does nothing for no rows")
{
    int called = 0;
    for (const std::string& name : tested_types())
    {
        CAPTURE(name);
        const auto type = library().require(name);
        REQUIRE(type.ok());
        const std::unique_ptr<TableBase> table = (*type)->info.make();
        Schema schema;
        table->describe(schema);
        for (const CommandInfo& command : (*type)->info.commands)
        {
            if (!command.run) continue;
            CAPTURE(command.name);
            Host host;
            const std::vector<std::uint8_t> before = host.state();
            const auto done = command.run(host.call, table->rows());
            CHECK_MESSAGE(done.ok(), reasons(done));
            CHECK(host.state() == before);
            CHECK(host.recorder.calls == 0);
            CHECK(host.changes.empty());
            for (const ColumnBase* column : schema.columns()) CHECK(column->size() == 0);
            ++called;
        }
    }
    CHECK(called > 0);
}
