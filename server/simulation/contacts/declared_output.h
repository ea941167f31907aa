/// An output that a component may declare under some name, and that the host writes. It is found once, when the scene changes.
#pragma once

#include <string_view>

#include "world/world.h"

namespace plab::simulation
{

template <class T>
class DeclaredOutput
{
public:
    DeclaredOutput() = default;
    /// Nothing is declared where `component` is kNoIndex or has no such output.
    DeclaredOutput(const world::World& world, std::uint32_t component, std::string_view name)
    {
        if (component == kNoIndex) return;
        const Field* field = world.table_of(component).schema().find_field(name);
        if (!field || field->kind != FieldKind::Output) return;
        row_ = world.component(component).row;
        output_ = dynamic_cast<Column<T>*>(field->column);
    }
    /// Null if nothing is declared.
    T* value() const { return output_ ? &(*output_)[row_] : nullptr; }

private:
    Column<T>* output_ = nullptr;
    Row row_ = 0;
};

}  // namespace plab::simulation
