/// Shafts, the constraint graph over them and couplings from the plugin: what a test of gears needs, without a step.
#pragma once

#include <doctest/doctest.h>

#include <cassert>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "plab/plugin.h"
#include "simulation/shafts/constraint_graph.h"
#include "simulation/shafts/shaft_coupling.h"
#include "simulation/shafts/shaft_reactions.h"

extern "C" void plab_plugin_register(plab::Registrar& registrar);

namespace plab::test
{

inline Ratio real_ratio(double value)
{
    Ratio r;
    r.value = value;
    return r;
}

inline Ratio exact_ratio(std::int64_t numerator, std::int64_t denominator)
{
    return {static_cast<double>(numerator) / static_cast<double>(denominator), true, numerator, denominator};
}

inline Ref shaft(std::uint32_t i) { return {Facet::Shaft, i}; }

inline double relative_error(double value, double reference)
{
    return reference == 0 ? std::fabs(value) : std::fabs(value - reference) / std::fabs(reference);
}

/// Shafts are named s0, s1, ..., components g0, g1, ...
struct Train
{
    Shafts shafts;
    simulation::ConstraintGraph graph;
    simulation::ShaftCoupling coupling;
    simulation::ShaftTorques torques;
    std::vector<std::uint32_t> members, prescribed;
    std::vector<std::uint32_t> shaft_rank, component_rank;
    std::uint32_t components = 0;

    std::uint32_t add_shaft(double inertia, double speed = 0, Motion motion = Motion::Dynamic)
    {
        const auto i = static_cast<std::uint32_t>(shafts.size());
        const bool dynamic = motion == Motion::Dynamic;
        shafts.motion.push_back(motion), shafts.angle.push_back(0), shafts.speed.push_back(speed);
        shafts.inertia.push_back(inertia), shafts.inverse_inertia.push_back(dynamic ? 1 / inertia : 0);
        shafts.axle.push_back({}), shafts.shapes.push_back({});
        shafts.root.push_back(i), shafts.ratio.push_back(1), shafts.anchor.push_back(0), shafts.root_anchor.push_back(0);
        (dynamic ? members : prescribed).push_back(i);
        return i;
    }
    std::uint32_t gear(std::uint32_t driver, std::uint32_t driven, const Ratio& ratio)
    {
        graph.add(components, shaft(driver), shaft(driven), ratio);
        return components++;
    }
    std::uint32_t gear(std::uint32_t driver, std::uint32_t driven, double ratio) { return gear(driver, driven, real_ratio(ratio)); }
    Result<void> try_build()
    {
        return graph.build(shafts, {shaft_rank, component_rank, [](std::uint32_t i) { return "s" + std::to_string(i); },
                                    [](std::uint32_t i) { return "g" + std::to_string(i); }});
    }
    void build()
    {
        const auto r = try_build();
        REQUIRE_MESSAGE(r.ok(), (r.ok() ? "" : r.error().text()));
    }
    std::string build_error()
    {
        const auto r = try_build();
        REQUIRE_FALSE(r.ok());
        return r.error().text();
    }
    void begin_accelerations(const std::vector<double>& torque)
    {
        coupling.begin_accelerations(graph, shafts, torque, members, prescribed);
    }
    void begin_speeds() { coupling.begin_speeds(graph, shafts, members, prescribed); }
    /// Accelerations of a scene without pairwise couplings.
    std::vector<double> accelerations(const std::vector<double>& torque)
    {
        begin_accelerations(torque);
        return rates();
    }
    std::vector<double> rates() const
    {
        std::vector<double> out(shafts.size());
        for (const std::uint32_t i : members) out[i] = coupling.rate(shaft(i));
        return out;
    }
    /// Torques of couplings after the last solve.
    void react() { torques.clear(), torques.add(coupling); }
    double torque(std::uint32_t component) const
    {
        const auto t = torques.torque(component);
        REQUIRE(t.has_value());
        return *t;
    }
};

/// The rows of one type of the plugin, declared and called as the host does.
class CouplingTable
{
public:
    explicit CouplingTable(const std::string& algorithm)
    {
        plab_plugin_register(registrar_);
        for (TypeInfo& t : registrar_.types())
            if (t.name == "Constraint/AngularVelocity/" + algorithm) type_ = &t;
        REQUIRE(type_ != nullptr);
        table_ = type_->make();
        table_->describe(schema_);
    }

    /// A row with defaults, and its component.
    Row add(std::uint32_t component, std::uint32_t driver, std::uint32_t driven, double factor)
    {
        const auto row = static_cast<Row>(rows_.size());
        rows_.push_back(row), component_of_row_.push_back(component);
        for (ColumnBase* c : schema_.columns()) c->resize(rows_.size());
        for (const Field& f : schema_.fields())
            if (type_of(f.fallback) != FieldType::None) f.column->set(row, f.fallback);
        (*schema_.find_role("driver")->one)[row] = shaft(driver);
        (*schema_.find_role("driven")->one)[row] = shaft(driven);
        set(row, "velocity_factor", factor);
        return row;
    }
    void set(Row row, const char* field, const Value& value) { schema_.find_field(field)->column->set(row, value); }
    double get(Row row, const char* field) const { return std::get<double>(schema_.find_field(field)->column->get(row)); }

    Result<void> prepare() { return run(Phase::Prepare, {}); }
    void couple(ShaftMotion& motion)
    {
        PhaseCall call;
        call.shaft_motion = &motion;
        const auto r = run(Phase::Couple, call);
        assert(r.ok());
    }
    void connect(RatioGraph& graph)
    {
        PhaseCall call;
        call.ratios = &graph;
        CHECK(run(Phase::Connect, call).ok());
    }
    void finish(Train& train)
    {
        PhaseCall call;
        call.shafts = &train.shafts, call.reactions = &train.torques;
        CHECK(run(Phase::Finish, call).ok());
    }
    const TypeInfo& type() const { return *type_; }
    const Schema& schema() const { return schema_; }

private:
    Result<void> run(Phase phase, PhaseCall call)
    {
        StepContext context;
        context.component_of_row = component_of_row_;
        call.context = &context, call.rows = rows_;
        for (const CommandInfo& c : type_->commands)
            if (c.phase == phase && c.run) return c.run(call, table_->rows());
        return reason("no such command");
    }

    Registrar registrar_;
    TypeInfo* type_ = nullptr;
    std::unique_ptr<TableBase> table_;
    Schema schema_;
    std::vector<Row> rows_;
    std::vector<std::uint32_t> component_of_row_;
};

}  // namespace plab::test
