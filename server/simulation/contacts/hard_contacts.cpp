#include "simulation/contacts/hard_contacts.h"

#include <algorithm>
#include <cmath>

namespace plab::simulation
{

void HardContacts::begin_step()
{
    const ContactBook::SearchChange change = contacts_.choose_search();
    if (change == ContactBook::SearchChange::Margins) held_.forget_state();
    if (sleeping_.begin_step()) held_.forget_state();
    held_.note_starts(sleeping_.may_sleep());
    parts_.begin_step();
    if (held_.any())
        for (held_.begin_step(change == ContactBook::SearchChange::Crowds); sleeping_.wake_touched(held_.fresh()); held_.begin_step(false))
            held_.forget_state();
    // A step that starts from a snapshot has to detect contacts that are otherwise known from the step before. This must not count in the
    // work budget, or the step would not be reproducible.
    step_.report.further_pairs = 0;
}

bool HardContacts::looks_once() const
{
    const auto once = [](const Detector& d) { return d.by_rows && d.persists() && !d.adapts; };
    return std::ranges::all_of(contacts_.detectors(), once);
}

bool HardContacts::has_looked_at_all() const
{
    const auto asleep = [](const BodyRest& b) { return b.asleep; };
    const std::vector<BodyRest>& rest = std::as_const(contacts_).cache().rest().bodies;
    return contacts_.is_of_present_structure() && looks_once() && std::ranges::none_of(rest, asleep) && held_.is_current();
}

bool HardContacts::needs_islands() const
{
    const auto pairs = contacts_.cache().pairs();
    return held_.holds_joints() || std::any_of(pairs.begin(), pairs.end(), [](const PairState& p) { return p.resting; });
}

void HardContacts::advance(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed, double from, double to,
                           WorkBook book, bool trial)
{
    join_islands(groups);
    const bool by_forces = parts_.measure(groups, from, to);
    const bool by_turns = turns_.measure(groups, places_, islands_, to - from);
    if (!by_forces && !by_turns) return advance_at_once(groups, observed, from, to, book, trial, !trial);
    list_divided(groups);
    if (!whole_.empty()) advance_at_once(whole_, observed, from, to, book, trial, !trial);
    advance_in_parts(observed, from, to, book, trial);
}

/// Distributes the groups over those of islands that advance in parts, and all others.
void HardContacts::list_divided(std::span<const std::uint32_t> groups)
{
    parts_of_.resize(step_.groups.all.size(), 0);
    for (const std::uint32_t g : groups)
    {
        std::uint32_t& parts = parts_of_[islands_.find(g)];
        parts = std::max({parts, parts_.of(g), turns_.of(g)});
    }
    divided_.clear(), whole_.clear();
    for (const std::uint32_t g : groups)
    {
        const std::uint32_t island = islands_.find(g);
        if (parts_of_[island] > 1)
            divided_.push_back({island, g});
        else
            whole_.push_back(g);
    }
    std::sort(divided_.begin(), divided_.end());
}

void HardContacts::advance_in_parts(std::span<const std::uint32_t> observed, double from, double to, WorkBook book, bool trial)
{
    for (auto first = divided_.begin(); first != divided_.end();)
    {
        const std::uint32_t island = first->island;
        part_members_.clear();
        for (; first != divided_.end() && first->island == island; ++first) part_members_.push_back(first->group);
        list_kinematic(island);
        const std::uint32_t parts = parts_of_[island];
        double begin = from;
        for (std::uint32_t k = 1; k <= parts && !step_.frame.give_up(); ++k)
        {
            const double end = k == parts ? to : from + (to - from) * k / parts;
            if (k > 1) motion_.put_prescribed(kinematic_, begin);
            advance_at_once(part_members_, observed, begin, end, book, trial, !trial && k == 1);
            begin = end;
        }
        motion_.put_prescribed(kinematic_, from);
    }
    std::ranges::fill(parts_of_, 0u);
}

/// Kinematic bodies that an island touches have groups of their own, which advance after it.
void HardContacts::list_kinematic(std::uint32_t island)
{
    const Bodies& bodies = step_.world.host().bodies;
    kinematic_.clear();
    for (const std::uint32_t place : places_)
    {
        const PairState& p = std::as_const(contacts_).cache().pairs()[place];
        for (const auto& [body, other] : {std::pair(p.a, p.b), std::pair(p.b, p.a)})
            if (bodies.motion[body.index] == Motion::Kinematic && bodies.dynamic(other.index) &&
                islands_.find(step_.groups.of(other)) == island)
                kinematic_.push_back(step_.groups.of(body));
    }
    std::sort(kinematic_.begin(), kinematic_.end());
    kinematic_.erase(std::unique(kinematic_.begin(), kinematic_.end()), kinematic_.end());
}

void HardContacts::advance_at_once(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed, double from, double to,
                                   WorkBook book, bool trial, bool begins)
{
    groups_.assign(groups.begin(), groups.end());
    held_.take(groups_, islands_, reached_.members(), places_);
    if (held_.holds_any()) held_.advance(observed, islands_, from, to, book, trial, begins);
    const std::size_t count = list_islands();
    for (std::size_t i = 0; i < count; ++i) impulses_.advance(members_[i], observed, from, to, book, trial, begins);
}

/// Joins the groups that persistent contacts hold together with some of `groups`. All others stay single sets, so that the cost of an
/// impact depends on what it touches.
void HardContacts::join_islands(std::span<const std::uint32_t> groups)
{
    const std::size_t count = step_.groups.all.size();
    if (islands_.size() == count)
        islands_.separate(reached_.members());
    else
        islands_.reset(count);
    reached_.begin(count);
    number_.resize(count);
    for (const std::uint32_t g : groups) reached_.add(g);
    // Springs may join any groups.
    if (motion_.extra())
        for (const std::uint32_t g : step_.all_groups) reached_.add(g);
    contacts_.resting().close_over(reached_, places_);
    const Bodies& bodies = step_.world.host().bodies;
    for (const std::uint32_t place : places_)
    {
        const PairState& p = contacts_.cache().pairs()[place];
        if (bodies.dynamic(p.a.index) && bodies.dynamic(p.b.index)) islands_.join(step_.groups.of(p.a), step_.groups.of(p.b));
    }
    if (motion_.extra()) motion_.extra()->join(islands_);
}

/// Distributes groups_ over members_: islands in the order of their first group. Returns the number of islands.
std::size_t HardContacts::list_islands()
{
    std::size_t count = 0;
    for (const std::uint32_t g : groups_) number_[islands_.find(g)] = kNoIndex;
    for (const std::uint32_t g : groups_)
    {
        std::uint32_t& number = number_[islands_.find(g)];
        if (number == kNoIndex)
        {
            number = static_cast<std::uint32_t>(count++);
            if (members_.size() < count) members_.emplace_back();
            members_[number].clear();
        }
        members_[number].push_back(g);
    }
    for (std::size_t i = 0; i < count; ++i) std::sort(members_[i].begin(), members_[i].end());
    return count;
}

/// Whether a pair has the same features as before, in the same order: mostly nothing begins or ends.
bool HardContacts::keeps_features(const PairState& pair, std::span<FoundContact> found)
{
    if (pair.count != found.size()) return false;
    for (std::uint32_t k = 0; k < pair.count; ++k)
        if (pair.contacts[k].feature != found[k].contact.feature) return false;
    for (std::uint32_t k = 0; k < pair.count; ++k) found[k].contact.id = pair.contacts[k].id, found[k].slot = k;
    return true;
}

void HardContacts::update_features(PairState& pair, std::span<FoundContact> found)
{
    const std::uint32_t known = pair.count;
    for (FoundContact& f : found) f.contact.id = contacts_.cache().contact_of(pair, f).id;
    const auto is_past = [&](const KnownContact& k)
    { return std::none_of(found.begin(), found.end(), [&](const FoundContact& f) { return f.contact.feature == k.feature; }); };
    if (pair.resting) held_.pass_on(pair, known, found);
    const std::span<KnownContact> all = pair.all();
    pair.count = static_cast<std::uint32_t>(std::remove_if(all.begin(), all.end(), is_past) - all.begin());
}

/// Lists the pairs that bodies pass over. Where they move to and fro over a seam, a contact on its other side ends at the edge.
void HardContacts::list_passed()
{
    passed_.clear();
    const std::span<const PairState> pairs = std::as_const(contacts_).cache().pairs();
    const std::span<const PairKey> keys = contacts_.cache().keys();
    std::size_t i = 0;
    for (const FoundRun& run : contacts_.runs())
    {
        while (i < keys.size() && keys[i] < run.key) ++i;
        if (i == keys.size()) return;
        if (keys[i] != run.key || !pairs[i].resting || pressed(pairs[i])) continue;
        if (contacts_.passes_over(std::span(contacts_.found()).subspan(run.first, run.end - run.first))) passed_.push_back(i);
    }
}

/// With its contacts of the end of the step: whether a pair is no longer known.
bool HardContacts::ends(PairState& pair, std::span<FoundContact> own, double time)
{
    double deepest = -HUGE_VAL;
    for (const FoundContact& f : own) deepest = std::max(deepest, f.contact.depth);
    const bool touches = deepest > 0 || (pair.resting && !own.empty() && deepest > -contacts_.persistence_margin(pair));
    const bool was_held = !touches && pressed(pair);
    const bool released = contacts_.report_release(pair);
    if (!keeps_features(pair, own)) update_features(pair, own);
    pair.overlapping = deepest > 0;
    if (!own.empty()) pair.normal = own.front().contact.normal;
    const bool ahead = held_.keeps_ahead(pair, touches, own, time);
    if (!touches && !ahead)
    {
        // A pair that pressed in the last step and does not touch at the end of this one was released in between.
        if (was_held && !released) step_.emit(contacts_.contact_event("contact.release", pair, time));
        if (!pair.ahead) step_.emit(contacts_.contact_event("contact.end", pair, time));
        return true;
    }
    step_.report.resting_pairs += pair.resting && !ahead ? 1 : 0;
    return false;
}

void HardContacts::finish_step()
{
    std::vector<FoundContact>& found = contacts_.found();
    const double time = step_.frame.start_time + step_.frame.step;
    if (held_.any())
    {
        held_.note_state();
        held_.adopt(found, time);
    }
    positions_.ease_overlaps();
    positions_.correct_positions();
    auto run = contacts_.runs().begin();
    const auto last = contacts_.runs().end();
    list_passed();
    std::size_t place = 0;
    auto passed = passed_.cbegin();
    const auto ended = [&](PairState& pair, const PairKey& key)
    {
        const bool passes = passed != passed_.cend() && *passed == place;
        if (passes) ++passed;
        ++place;
        while (run != last && run->key < key) ++run;
        const bool any = run != last && run->key == key && !passes;
        return ends(pair, any ? std::span(found).subspan(run->first, run->end - run->first) : std::span<FoundContact>(), time);
    };
    contacts_.cache().drop_if(ended);
    if (held_.any() && (held_.has_passed() || !passed_.empty())) held_.adopt_again(found, time);
    for (const FoundContact& f : found) step_.report.deepest = std::max(step_.report.deepest, f.contact.depth);
    for (const auto& island : contacts_.cache().rest().islands)
        step_.report.resting_pairs +=
            static_cast<int>(std::count_if(island->pairs.begin(), island->pairs.end(), [](const PairState& p) { return !p.ahead; }));
    parts_.finish_step();
    // What was detected at velocities that are gone does not serve the next step.
    if (sleeping_.finish_step(held_.starts(), held_.fresh())) held_.forget_state();
}

}  // namespace plab::simulation
