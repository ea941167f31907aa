// Changes of single components that can be taken back: World's part of it (undo_log.h).
#include <algorithm>
#include <utility>

#include "world/world.h"

namespace plab::world
{

UndoLog* World::note_in(UndoLog* log)
{
    if (log && log->entries.empty()) log->parked = parked_.size();
    return std::exchange(undo_, log);
}

void World::count_change(const model::ComponentType& type)
{
    if (type.only_advances()) return (void)++revisions_.solvers;
    if (type.only_answers_contacts()) return (void)++revisions_.answers;
    ++revisions_.others;
    if (type.concerns_contacts()) ++revisions_.contacts;
}

void World::note(std::uint32_t i)
{
    const Component& c = component(i);
    if (c.table == kNoIndex) return;
    count_change(tables_[c.table]->type());
    if (!undo_ || !undo_->noted.insert(i).second) return;
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
        count_change(tables_[now.table]->type());
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
        count_change(tables_[e.before.table]->type());
        ByteReader cells(e.cells);
        tables_[e.before.table]->load(e.before.row, kLiveKinds, cells);
        e.host.restore(host_);
    }
}

}  // namespace plab::world
