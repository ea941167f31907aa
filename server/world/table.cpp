#include "world/table.h"

#include <algorithm>

namespace plab::world
{
namespace
{

std::shared_ptr<const Layout> layout_of(const TypeInfo& info, const Schema& schema)
{
    auto out = std::make_shared<Layout>();
    out->type = info.name, out->facet = info.facet;
    for (const Field& field : schema.fields())
        if ((kLiveKinds & kind_bit(field.kind)) && !field.hosted && field.type != FieldType::Opaque)
            out->fields.push_back({field.name, field.kind, field.type});
    return out;
}

}  // namespace

Table::Table(const model::ComponentType& type) : type_(&type), storage_(type.info.make())
{
    storage_->describe(schema_);
    layout_ = layout_of(type.info, schema_);
    columns_ = schema_.columns();
}

Row Table::add(std::uint32_t component, std::uint32_t host_index)
{
    Row row = 0;
    if (free_.empty())
    {
        row = static_cast<Row>(component_of_row_.size());
        component_of_row_.push_back(kNoIndex);
        host_of_row_.push_back(kNoIndex);
        for (ColumnBase* column : columns_) column->resize(component_of_row_.size());
    }
    else
    {
        row = free_.back();
        free_.pop_back();
    }
    assign(row, component, host_index);
    for (const Field& field : schema_.fields())
        if (field.type != FieldType::Opaque && type_of(field.fallback) == field.type) field.column->set(row, field.fallback);
    return row;
}

void Table::remove(Row row)
{
    for (ColumnBase* column : columns_) column->reset(row);
    assign(row, kNoIndex, kNoIndex);
    free_.push_back(row);
}

void Table::assign(Row row, std::uint32_t component, std::uint32_t host_index)
{
    component_of_row_[row] = component;
    host_of_row_[row] = host_index;
}

bool Table::holds(unsigned kinds) const
{
    const auto& fields = schema_.fields();
    return std::any_of(fields.begin(), fields.end(), [&](const Field& f) { return (kinds & kind_bit(f.kind)) && !f.hosted; });
}

void Table::save(Row row, unsigned kinds, ByteWriter& out) const
{
    for (const Field& field : schema_.fields())
        if ((kinds & kind_bit(field.kind)) && !field.hosted) field.column->save(row, out);
}

void Table::load(Row row, unsigned kinds, ByteReader& in)
{
    for (const Field& field : schema_.fields())
        if ((kinds & kind_bit(field.kind)) && !field.hosted) field.column->load(row, in);
}

}  // namespace plab::world
