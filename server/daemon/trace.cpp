#include "daemon/trace.h"

#include <cerrno>
#include <cstring>

#include "daemon/output.h"
#include "model/values.h"
#include "world/host_tables.h"

namespace plab::daemon
{
namespace
{

/// Denotes the work that a component has done, which is not one of its fields.
constexpr const char* kWork = "work";

std::vector<std::string> fields_of_object(const world::Component& c)
{
    if (c.facet == Facet::Quantities) return {"values"};
    if (c.facet == Facet::Shaft) return {"angle", "angular_velocity"};
    return {"position", "orientation", "linear_velocity", "angular_velocity"};
}

Value value_of(const simulation::Simulation& s, std::uint32_t i, const std::string& field)
{
    const world::Component& c = s.world().component(i);
    // Not every type of body declares its whole motion: a static body has no speed to set, but is traced as well.
    if (c.facet == Facet::Body || c.facet == Facet::Shaft) return world::get_hosted(s.world().host(), c.facet, c.host_index, field);
    if (field != kWork) return s.world().get(i, field);
    const std::vector<double>& work = s.stepper().work();
    return Value(i < work.size() ? work[i] : 0.0);
}

}  // namespace

void Trace::add(const simulation::Simulation& s, std::uint32_t i, const std::string& field, bool output, CsvRow& header)
{
    const std::vector<std::string> suffixes = model::number_suffixes(value_of(s, i, field));
    if (suffixes.empty()) return;
    columns_.push_back({s.world().id_of(i), field, suffixes.size(), output});
    for (const std::string& suffix : suffixes) header.text(s.world().id_of(i) + "." + field + suffix);
}

Result<std::unique_ptr<Trace>> Trace::open(const std::string& file, const simulation::Simulation& s, double every)
{
    std::unique_ptr<Trace> trace(new Trace);
    trace->file_.reset(std::fopen(file.c_str(), "w"));
    if (!trace->file_) return reason("cannot write " + file + ": " + std::strerror(errno));
    trace->every_ = every;
    CsvRow header;
    header.put("time,step,hash,energy,kinetic,momentum_x,momentum_y,momentum_z");
    const world::World& world = s.world();
    for (const std::uint32_t i : world.in_id_order())
        if (is_shown(world.component(i)))
            for (const std::string& field : fields_of_object(world.component(i))) trace->add(s, i, field, false, header);
    for (const std::uint32_t i : world.in_id_order())
    {
        if (!is_listed(world, i)) continue;
        trace->add(s, i, kWork, true, header);
        for (const Field& field : world.table_of(i).schema().fields())
            if (field.kind == FieldKind::Output) trace->add(s, i, field.name, true, header);
    }
    trace->write(header);
    return trace;
}

void Trace::sample(const simulation::Simulation& s, bool last)
{
    if (s.tick() == last_ || (!last && s.time() < next_ * (1 - 1e-12))) return;
    last_ = s.tick();
    while (every_ > 0 && next_ <= s.time() * (1 + 1e-12)) next_ += every_;
    const simulation::Totals t = s.totals();
    CsvRow row;
    row.put(number(s.time())).whole(s.tick()).hexadecimal(s.state_hash());
    for (const double v : {t.kinetic + t.stored, t.kinetic, t.momentum.x, t.momentum.y, t.momentum.z}) row.put(number(v));
    std::vector<double> values;
    for (const Columns& c : columns_)
    {
        // A component that was removed, or exchanged for a type without that output, leaves its columns empty.
        const std::uint32_t i = s.world().find(c.component);
        const bool there = i != kNoIndex && (c.output ? is_listed(s.world(), i) : is_shown(s.world().component(i)));
        const bool known = there && (!c.output || c.field == kWork || s.world().table_of(i).schema().find_field(c.field));
        values.clear();
        if (known) model::append_numbers(value_of(s, i, c.field), values);
        for (std::size_t k = 0; k < c.count; ++k) row.put(k < values.size() ? number(values[k]) : std::string());
    }
    write(row);
}

void Trace::write(CsvRow& row)
{
    row.end();
    const std::string line = row.take();
    (void)std::fwrite(line.data(), 1, line.size(), file_.get());
}

}  // namespace plab::daemon
