#include "world/undo_log.h"

#include "world/host_columns.h"

namespace plab::world
{

HostRow::HostRow(const HostTables& tables, Facet facet, std::uint32_t index) : facet_(facet), index_(index)
{
    if (index == kNoIndex) return;
    if (facet == Facet::Body)
    {
        for_each_column(kBodyColumns, [&](auto column) { (body_.*column).push_back((tables.bodies.*column)[index]); });
        body_.shapes.push_back(tables.bodies.shapes[index]);
    }
    if (facet == Facet::Shaft)
    {
        for_each_column(kShaftColumns, [&](auto column) { (shaft_.*column).push_back((tables.shafts.*column)[index]); });
        shaft_.axle.push_back(tables.shafts.axle[index]), shaft_.shapes.push_back(tables.shafts.shapes[index]);
    }
    if (facet == Facet::Quantities) quantities_ = tables.quantities.value[index];
    if (facet == Facet::Shape)
        geometry_ = tables.shapes.geometry[index], solid_ = tables.shapes.solid[index], unmeasurable_ = tables.shapes.unmeasurable[index];
}

void HostRow::restore(HostTables& tables) const
{
    const std::uint32_t i = index_;
    if (i == kNoIndex) return;
    if (facet_ == Facet::Body)
    {
        for_each_column(kBodyColumns, [&](auto column) { (tables.bodies.*column)[i] = (body_.*column).front(); });
        tables.bodies.shapes[i] = body_.shapes.front();
    }
    if (facet_ == Facet::Shaft)
    {
        for_each_column(kShaftColumns, [&](auto column) { (tables.shafts.*column)[i] = (shaft_.*column).front(); });
        tables.shafts.axle[i] = shaft_.axle.front(), tables.shafts.shapes[i] = shaft_.shapes.front();
    }
    if (facet_ == Facet::Quantities) tables.quantities.value[i] = quantities_;
    if (facet_ == Facet::Shape)
        tables.shapes.geometry[i] = geometry_, tables.shapes.solid[i] = solid_, tables.shapes.unmeasurable[i] = unmeasurable_;
}

}  // namespace plab::world
