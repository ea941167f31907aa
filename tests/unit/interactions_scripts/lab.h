/// A test bench for one script without a world: a body, a second one, two shafts, and the calls that the host makes.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "script.h"
#include "support/events.h"

namespace plab::scripts::test
{

using plab::test::Events;

/// driver: shaft 0 (name it so in comments), driven: body 0 or shaft 1, between: bodies 0 and 1.
struct Lab
{
    ScriptRows rows;
    Schema schema;
    Bodies bodies;
    Shafts shafts;
    Quantities quantities;
    Wrenches wrenches;
    Events events;
    std::vector<ParameterChange> changes;
    std::vector<std::uint32_t> owners{7};
    std::vector<double> power = std::vector<double>(8, 0.0);
    StepContext context;

    static constexpr Ref kBody0{Facet::Body, 0}, kBody1{Facet::Body, 1}, kShaft0{Facet::Shaft, 0}, kShaft1{Facet::Shaft, 1};

    Lab()
    {
        rows.describe(schema);
        for (ColumnBase* column : schema.columns()) column->resize(1);
        for (const Field& f : schema.fields())
            if (f.type != FieldType::Opaque && !f.required) f.column->set(0, f.fallback);
        for (int i = 0; i < 2; ++i) add_body(), add_shaft();
        wrenches = Wrenches(bodies, shafts);
        wrenches.power = &power;
        clear();
        context.dt = 0.01, context.seed = 42;
        context.events = &events, context.changes = &changes, context.component_of_row = owners;
    }
    explicit Lab(const std::string& code) : Lab() { rows.code[0] = code; }
    Lab(const Lab&) = delete;

    void clear()
    {
        wrenches.force.assign(2, {}), wrenches.torque.assign(2, {}), wrenches.shaft_torque.assign(2, 0);
        wrenches.quantity_rate.assign(quantities.size(), {});
        for (std::size_t i = 0; i < quantities.size(); ++i) wrenches.quantity_rate[i].assign(quantities.value[i].size(), 0);
        power.assign(8, 0);
    }
    /// The reason why the code is refused, or nothing.
    std::string prepare()
    {
        const auto r = scripts::prepare(context, 0, rows);
        return r ? "" : r.error().text();
    }
    void drive()
    {
        context.changes = &changes;
        scripts::drive(context, kRows, rows, bodies, shafts, quantities);
        context.changes = nullptr;
    }
    void force()
    {
        clear();
        scripts::force(context, kRows, rows, bodies, shafts, quantities, wrenches);
    }
    void finish() { scripts::finish(context, kRows, rows); }
    void step()
    {
        drive();
        force();
        finish();
        ++context.tick;
        context.time = static_cast<double>(context.tick) * context.dt;
    }
    /// The kind and message of the only event, or what is wrong with that.
    std::string only_event() const
    {
        if (events.all.size() != 1) return std::to_string(events.all.size()) + " events";
        return events.all[0].kind + ": " + events.all[0].message;
    }
    double state(const std::string& name) const
    {
        for (const plab::Entry& e : rows.state[0])
            if (e.name == name) return std::get<double>(e.value);
        return -1e300;
    }

private:
    static constexpr Row kRow[] = {0};
    static constexpr Rows kRows{kRow};

    void add_body()
    {
        bodies.motion.push_back(Motion::Dynamic);
        bodies.position.emplace_back(), bodies.orientation.emplace_back(), bodies.velocity.emplace_back();
        bodies.angular_velocity.emplace_back(), bodies.angular_momentum.emplace_back();
        bodies.mass.push_back(1), bodies.inverse_mass.push_back(1);
        bodies.inertia_B.push_back(Mat3::identity()), bodies.inverse_inertia_B.push_back(Mat3::identity());
        bodies.center_B.emplace_back(), bodies.material.push_back(0), bodies.shapes.emplace_back();
    }
    void add_shaft()
    {
        shafts.motion.push_back(Motion::Dynamic);
        shafts.angle.push_back(0), shafts.speed.push_back(0), shafts.inertia.push_back(1);
        shafts.inverse_inertia.push_back(1), shafts.axle.emplace_back(), shafts.shapes.emplace_back();
    }
};

inline double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace plab::scripts::test
