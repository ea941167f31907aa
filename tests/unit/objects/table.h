/// A component type's table without a world: rows with the declared defaults, and the context of an Init phase.
#pragma once

#include <vector>

#include "plab/registrar.h"

namespace plab::test
{

template <class Table>
struct TableFixture
{
    Table rows;
    Schema schema;
    std::vector<std::uint32_t> indices;

    explicit TableFixture(Row count = 1)
    {
        rows.describe(schema);
        for (ColumnBase* column : schema.columns()) column->resize(count);
        for (const Field& field : schema.fields())
            for (Row row = 0; row < count && type_of(field.fallback) != FieldType::None; ++row) field.column->set(row, field.fallback);
        for (Row row = 0; row < count; ++row) indices.push_back(row);
    }
    /// Row i is component i and host row i.
    StepContext context() const
    {
        StepContext c;
        c.component_of_row = indices;
        c.facet_of_row = indices;
        return c;
    }
};

inline Bodies make_bodies(std::size_t n)
{
    Bodies b;
    b.motion.resize(n), b.position.resize(n), b.orientation.resize(n), b.velocity.resize(n);
    b.angular_velocity.resize(n), b.angular_momentum.resize(n), b.mass.resize(n), b.inverse_mass.resize(n);
    b.inertia_B.resize(n), b.inverse_inertia_B.resize(n), b.center_B.resize(n), b.needle.resize(n), b.material.resize(n);
    b.shapes.resize(n);
    return b;
}

inline Shafts make_shafts(std::size_t n)
{
    Shafts s;
    s.motion.resize(n), s.angle.resize(n), s.speed.resize(n), s.inertia.resize(n), s.inverse_inertia.resize(n);
    s.axle.resize(n), s.shapes.resize(n);
    return s;
}

inline Shapes make_shapes(std::size_t n)
{
    Shapes s;
    s.geometry.resize(n), s.solid.resize(n), s.unmeasurable.resize(n);
    return s;
}

inline double largest_difference(const Mat3& a, const Mat3& b)
{
    double most = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) most = std::fmax(most, std::fabs(a(i, j) - b(i, j)));
    return most;
}

inline std::string reason_of(const Result<void>& result) { return result ? "accepted" : result.error().reason; }

}  // namespace plab::test
