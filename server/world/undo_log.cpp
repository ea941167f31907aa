#include "world/undo_log.h"

#include <algorithm>
#include <utility>

#include "world/host_columns.h"
#include "world/world.h"

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

UndoLog* World::note_in(UndoLog* log)
{
    if (log && log->entries.empty()) log->parked = parked_.size();
    return std::exchange(undo_, log);
}

void World::note(std::uint32_t i)
{
    const Component& c = component(i);
    if (!undo_ || c.table == kNoIndex || !undo_->noted.insert(i).second) return;
    ByteWriter cells;
    tables_[c.table]->save(c.row, kLiveKinds, cells);
    undo_->entries.push_back({i, c, cells.bytes(), {host_, c.facet, c.host_index}});
}

void World::take_back(const UndoLog& log)
{
    undo_ = nullptr;
    for (auto spec = log.specs.rbegin(); spec != log.specs.rend(); ++spec) scene_.edit().components.replace(spec->place, spec->before);
    for (const UndoLog::Entry& e : log.entries)
    {
        const Component now = component(e.component);
        if (now.quarantined != e.before.quarantined || now.table != e.before.table || now.row != e.before.row)
            directory_.edit().components[e.component] = e.before;
        if (now.table == e.before.table && now.row == e.before.row) continue;
        tables_[now.table]->remove(now.row);
        tables_[e.before.table]->assign(e.before.row, e.component, e.before.host_index);
    }
    // A component that was exchanged twice has left a row that nobody owns any more.
    for (std::size_t k = log.parked; k < parked_.size(); ++k)
        if (Table& table = *tables_[parked_[k].table]; table.component_of_row()[parked_[k].row] == kNoIndex) table.remove(parked_[k].row);
    parked_.resize(std::min(log.parked, parked_.size()));
    restore_values(log);
}

void World::restore_values(const UndoLog& log)
{
    for (const UndoLog::Entry& e : log.entries)
    {
        ByteReader cells(e.cells);
        tables_[e.before.table]->load(e.before.row, kLiveKinds, cells);
        e.host.restore(host_);
    }
}

}  // namespace plab::world
