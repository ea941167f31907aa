#include "round.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "template_text.h"

namespace plab::rules
{
namespace
{

constexpr std::string_view kDrawing = ".draw";

std::string millimetres(double metre)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.3g mm", 1e3 * metre);
    return text;
}

}  // namespace

Round::Round(const Scene& scene, Row row, RuleRows& rules, RequestSink& requests)
    : scene_(scene),
      lookup_(*scene.context.lookup),
      row_(row),
      rules_(rules),
      requests_(requests),
      memory_(memory_of(row)),
      bounds_(rules.bounds(row))
{
}

/// The memory of a rule, brought up to date. What was asked for and is not there was refused, or removed.
Memory& Round::memory_of(Row row) const
{
    Memory& memory = *rules_.memory[row];
    if (memory.is_fresh(lookup_, scene_.context.tick)) return memory;
    memory.refresh(lookup_, rules_.a.wanted(row), rules_.b.wanted(row), rules_.links[row]);
    bool lost = false;
    for (Link& link : memory.links)
    {
        const std::string id = link.progress == Progress::Drawing ? link.id + std::string(kDrawing) : link.id;
        if (link.progress == Progress::Refused || lookup_.exists(id)) continue;
        link.progress = Progress::Refused, lost = true;
    }
    if (lost) rules_.links[row] = to_entries(memory.links);
    return memory;
}

Measures Round::measures_of(const Memory& memory, std::uint32_t a, std::uint32_t b) const
{
    return measure(place_of(memory.sites[a], scene_.bodies, scene_.shafts), place_of(memory.sites[b], scene_.bodies, scene_.shafts));
}

void Round::run()
{
    look_after_links();
    meet();
    if (!changed_) return;
    memory_.index_links();
    rules_.links[row_] = to_entries(memory_.links);
}

// Links -------------------------------------------------------------------------------------------------------------------

void Round::look_after_links()
{
    const auto gone = [this](Link& link) { return !look_after(link); };
    const auto first_gone = std::remove_if(memory_.links.begin(), memory_.links.end(), gone);
    if (first_gone == memory_.links.end()) return;
    memory_.links.erase(first_gone, memory_.links.end());
    changed_ = true;
    memory_.index_links();
}

/// Returns false if the rule has no more to do with the two.
bool Round::look_after(Link& link)
{
    const bool there = link.site_a != kNoIndex && link.site_b != kNoIndex;
    if (there)
    {
        Bounds bounds = bounds_for(row_, memory_.sites[link.site_a], memory_.sites[link.site_b]);
        if (link.progress == Progress::Drawing) bounds.kind = Kind::Near;
        const Measures m = measures_of(memory_, link.site_a, link.site_b);
        if (holds(bounds, m, memory_.sites[link.site_a].radius, memory_.sites[link.site_b].radius, rules_.hold[row_]))
        {
            if (link.progress == Progress::Drawing && is_latched(link)) latch(link);
            return true;
        }
    }
    if (link.progress == Progress::Refused) return false;
    const bool drawing = link.progress == Progress::Drawing;
    if (!drawing && !rules_.removes[row_]) return true;
    requests_.ask(row_, "remove", drawing ? link.id + std::string(kDrawing) : link.id, "", link.a + " and " + link.b + " have parted");
    return false;
}

bool Round::is_latched(const Link& link) const
{
    const Site &a = memory_.sites[link.site_a], &b = memory_.sites[link.site_b];
    const Place at_a = place_of(a, scene_.bodies, scene_.shafts), at_b = place_of(b, scene_.bodies, scene_.shafts);
    const Measures m = measure(at_a, at_b);
    const Vec3 slip = velocity_of(b, scene_.bodies, scene_.shafts) - velocity_of(a, scene_.bodies, scene_.shafts);
    if (m.distance > rules_.latch[row_] || m.angle > rules_.latch_angle[row_] || length(slip) > rules_.latch_speed[row_]) return false;
    if (!rules_.turns[row_]) return true;
    const Quat q = conjugate(at_a.X.q) * at_b.X.q;
    return 2 * std::atan2(length(Vec3{q.x, q.y, q.z}), std::fabs(q.w)) <= rules_.latch_angle[row_];
}

/// What draws them stands until the template does: there is no step in between.
void Round::latch(Link& link)
{
    Pair pair{link.site_a, link.site_b, measures_of(memory_, link.site_a, link.site_b), {}};
    changed_ = true, memory_.asked_at = scene_.context.tick;
    if (!applies(row_, pair))
        link.progress = Progress::Refused;
    else if (const std::string loop = couple(pair, link.id); !loop.empty())
    {
        link.progress = Progress::Refused;
        scene_.context.emit(row_, "rule.refused", Severity::Warning, words(pair) + ": " + loop);
    }
    else if (const auto text = blueprint_for(pair); !text)
    {
        link.progress = Progress::Refused;
        scene_.context.emit(row_, "rule.refused", Severity::Warning, words(pair) + ": " + text.error().reason);
    }
    else
    {
        link.progress = Progress::Made, ++rules_.made[row_];
        requests_.ask(row_, "add", "", *text, words(pair) + " are latched");
    }
    requests_.ask(row_, "remove", link.id + std::string(kDrawing), "", words(pair) + " are drawn no more");
}

// Pairs that meet ---------------------------------------------------------------------------------------------------------

void Round::meet()
{
    for (const auto& [i, j] : memory_.near_pairs(scene_.bodies, scene_.shafts, bounds_.reach))
    {
        const Site &one = memory_.sites[i], &other = memory_.sites[j];
        const bool in_order = one.is_a && other.is_b;
        if (!in_order && !(other.is_a && one.is_b)) continue;
        if (one.object == other.object || memory_.find(i, j)) continue;
        Pair pair{in_order ? i : j, in_order ? j : i, {}, {}};
        pair.measures = measures_of(memory_, pair.a, pair.b);
        if (!applies(row_, pair) || is_full(row_, pair) || yields(pair)) continue;
        make(std::move(pair));
    }
}

bool Round::applies(Row row, Pair& pair) const
{
    const Memory& memory = *rules_.memory[row];
    const Site &a = memory.sites[pair.a], &b = memory.sites[pair.b];
    if (!is_dynamic(a, scene_.bodies, scene_.shafts) && !is_dynamic(b, scene_.bodies, scene_.shafts)) return false;
    Bounds bounds = bounds_for(row, a, b);
    if (rules_.draw[row] > 0) bounds.kind = Kind::Near;
    if (!holds(bounds, pair.measures, a.radius, b.radius)) return false;
    pair.values = rules_.values[row];
    for (Entry& entry : pair.values)
        if (const auto* expression = std::get_if<std::string>(&entry.value))
        {
            const auto value = number_of(*expression, [&](std::string_view name) { return known(row, pair, name); });
            if (!value) return false;
            entry.value = *value;
        }
    if (!memory.condition) return true;
    const auto answer = memory.condition->applies(scene_.context, row, a.object, b.object, pair.measures, a.radius, b.radius, pair.values,
                                                  scene_.bodies, scene_.shafts, scene_.quantities);
    if (!answer) scene_.context.emit(row, "rule.failed", Severity::Failure, answer.error().reason);
    return answer && *answer;
}

bool Round::is_full(Row row, const Pair& pair) const
{
    const Memory& memory = *rules_.memory[row];
    const auto full = [&](std::int64_t most, std::uint32_t site) { return most > 0 && memory.count_at(site) >= most; };
    return full(rules_.a.most[row], pair.a) || full(rules_.b.most[row], pair.b);
}

/// A connector may be looser than the rule.
Bounds Round::bounds_for(Row row, const Site& a, const Site& b) const
{
    Bounds out = row == row_ ? bounds_ : rules_.bounds(row);
    out.tolerance = std::max({out.tolerance, a.tolerance, b.tolerance});
    return out;
}

bool Round::precedes(Row other) const
{
    if (rules_.priority[other] != rules_.priority[row_]) return rules_.priority[other] > rules_.priority[row_];
    const auto id = [this](Row row) { return lookup_.id_of(scene_.context.component_of_row[row]); };
    return id(other) < id(row_);
}

bool Round::yields(const Pair& pair) const
{
    const Ref a = memory_.sites[pair.a].object, b = memory_.sites[pair.b].object;
    for (Row other = 0; other < scene_.context.component_of_row.size(); ++other)
    {
        if (other == row_ || scene_.context.component_of_row[other] == kNoIndex || !rules_.memory[other]) continue;
        if (rules_.slot[other] != rules_.slot[row_]) continue;
        const Memory& theirs = memory_of(other);
        if (theirs.links_objects(a, b)) return true;
        if (!precedes(other)) continue;
        for (const auto& [ref_1, one] : theirs.sites_on(a))
            for (const auto& [ref_2, two] : theirs.sites_on(b))
                for (const auto& [site_a, site_b] : {std::pair(one, two), std::pair(two, one)})
                {
                    Pair seen{site_a, site_b, {}, {}};
                    if (!theirs.sites[site_a].is_a || !theirs.sites[site_b].is_b) continue;
                    seen.measures = measures_of(theirs, site_a, site_b);
                    if (applies(other, seen) && !is_full(other, seen)) return true;
                }
    }
    return false;
}

void Round::make(Pair pair)
{
    Link link;
    link.a = lookup_.id_of(memory_.sites[pair.a].component), link.b = lookup_.id_of(memory_.sites[pair.b].component);
    link.site_a = pair.a, link.site_b = pair.b;
    const auto text = blueprint_for(pair);
    link.id = text ? first_id(*text) : link.a + " " + link.b;
    if (ids_.empty())
        for (const Link& l : memory_.links) ids_.insert(l.id);
    const bool taken = !ids_.insert(link.id).second;
    // What is only drawn is not coupled yet.
    const std::string loop = text && !taken && rules_.draw[row_] == 0 ? couple(pair, link.id) : std::string();
    if (!loop.empty())
    {
        link.progress = Progress::Refused;
        scene_.context.emit(row_, "rule.refused", Severity::Warning, words(pair) + ": " + loop);
    }
    else if (!text || taken)
    {
        // The template's id must name both, or the second pair of objects would need the same one.
        link.progress = Progress::Refused;
        if (taken) link.id += " (" + link.a + ", " + link.b + ")";
        scene_.context.emit(row_, "rule.refused", Severity::Warning,
                            words(pair) + ": " +
                                (text ? "the id '" + first_id(*text) + "' is taken; does it contain ${a} and ${b}?" : text.error().reason));
    }
    else if (rules_.draw[row_] > 0)
    {
        link.progress = Progress::Drawing;
        requests_.ask(row_, "add", "", drawing_for(pair, link.id), words(pair) + " are near: " + millimetres(pair.measures.distance));
    }
    else
    {
        ++rules_.made[row_];
        requests_.ask(row_, "add", "", *text, words(pair) + " meet");
    }
    memory_.links.push_back(std::move(link));
    changed_ = true, memory_.asked_at = scene_.context.tick;
}

std::string Round::words(const Pair& pair) const
{
    return std::string(lookup_.id_of(memory_.sites[pair.a].component)) + " and " +
           std::string(lookup_.id_of(memory_.sites[pair.b].component));
}

}  // namespace plab::rules
