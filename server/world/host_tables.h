/// The host tables of a world, as one value: a copy is a complete backup.
#pragma once

#include <string_view>
#include <vector>

#include "plab/bytes.h"
#include "plab/collision_filter.h"
#include "plab/result.h"
#include "plab/tables.h"

namespace plab::world
{

struct HostTables
{
    Bodies bodies;
    Shafts shafts;
    Quantities quantities;
    Shapes shapes;
    Materials materials;
    CollisionFilter filter;
    std::vector<std::uint32_t> free_bodies, free_shafts, free_shapes, free_quantities;
    std::vector<std::uint32_t> component_of_body, component_of_shaft, component_of_shape, component_of_quantities;  ///< directory indices

    /// Adds a row for a component with this facet; kNoIndex if the facet has no table.
    std::uint32_t add(Facet facet, std::uint32_t component);
    void remove(Facet facet, std::uint32_t index);
    /// The row belongs to no component from now on, but only remove() frees it, because a rollback may need it again.
    void disown(Facet facet, std::uint32_t index);
    std::uint32_t component_of(Ref ref) const;
};

inline std::uint32_t HostTables::component_of(Ref ref) const
{
    switch (ref.facet)
    {
        case Facet::Body:
            return component_of_body[ref.index];
        case Facet::Shaft:
            return component_of_shaft[ref.index];
        case Facet::Shape:
            return component_of_shape[ref.index];
        case Facet::Quantities:
            return component_of_quantities[ref.index];
        case Facet::Component:
            break;
    }
    return ref.index;
}

/// Fields whose live values are in the host tables, by the names that the State types declare (server/docs/notation.md). `index` is the
/// host row. An unknown name or facet gives no value.
Value get_hosted(const HostTables& tables, Facet facet, std::uint32_t index, std::string_view name);
/// False if there is no such field. Angular momentum follows a changed velocity.
bool set_hosted(HostTables& tables, Facet facet, std::uint32_t index, std::string_view name, const Value& value);

/// Raw state of one host row, for mementos and hashes.
void save_state(const HostTables& tables, Ref ref, ByteWriter& out);

/// The moving state of all bodies and shafts at one time. It keeps its memory, so saving is a copy of arrays.
class MotionMemento
{
public:
    void save(const HostTables& tables);
    /// The same, if no other bodies than `bodies` have changed since the last time.
    void save_some(const HostTables& tables, std::span<const std::uint32_t> bodies);
    /// Makes room for all rows, whose contents are unspecified until they are saved.
    void fit(const HostTables& tables);
    /// Makes room for these rows only (ascending), the only ones that may be saved and restored from now on, one by one.
    void fit_rows(std::vector<std::uint32_t> bodies, std::vector<std::uint32_t> shafts, std::vector<std::uint32_t> quantities);
    void restore(HostTables& tables) const;
    void save_body(const HostTables& tables, std::uint32_t i);
    void save_shaft(const HostTables& tables, std::uint32_t i);
    void restore_body(HostTables& tables, std::uint32_t i) const;
    void restore_shaft(HostTables& tables, std::uint32_t i) const;
    void save_quantities(const HostTables& tables, std::uint32_t i);
    void restore_quantities(HostTables& tables, std::uint32_t i) const;

private:
    void resize(std::size_t bodies, std::size_t shafts, std::size_t quantities);
    std::size_t place(const std::vector<std::uint32_t>& rows, std::uint32_t row) const;

    bool some_ = false;  ///< only the rows of the following lists
    std::vector<std::uint32_t> bodies_, shafts_, quantity_rows_;
    std::vector<Vec3> position_, velocity_, angular_velocity_, angular_momentum_;
    std::vector<Quat> orientation_;
    std::vector<double> angle_, speed_, anchor_, root_anchor_;
    std::vector<std::vector<double>> quantities_;
};

}  // namespace plab::world
