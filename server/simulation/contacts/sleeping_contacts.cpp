#include "simulation/contacts/sleeping_contacts.h"

#include <algorithm>

namespace plab::simulation
{

void SleepingContacts::finish_step()
{
    ContactLog& log = contacts_.log();
    const RestState& rest = std::as_const(contacts_).cache().rest();
    if (rest.islands.empty()) return;
    // An island that has just fallen asleep was still advanced in this step.
    log.take_back(-1, [&](Ref r) { return r.facet == Facet::Body && rest.asleep(r.index); });
    if (!mark_ || mark_ != rest.mark)
    {
        mark_ = rest.mark;
        before_.swap(known_), known_.clear(), all_.clear();
        for (const auto& island : rest.islands)
        {
            const auto same = std::find_if(before_.begin(), before_.end(), [&](const Known& k) { return k.island == island; });
            Known& now = known_.emplace_back();
            now.island = island;
            if (same != before_.end())
                now.contacts = std::move(same->contacts);
            else
                find_in(*island, now.contacts);
            all_.insert(all_.end(), now.contacts.begin(), now.contacts.end());
        }
        before_.clear();
    }
    log.show_sleeping(all_);
}

void SleepingContacts::find_in(const SleepingIsland& island, std::vector<LoggedContact>& out)
{
    const std::vector<Detector>& detectors = contacts_.detectors();
    for (std::uint32_t d = 0; d < detectors.size(); ++d)
    {
        persistent_.clear(), found_.clear();
        double margin = 0;
        for (const PairState& p : island.pairs)
        {
            if (p.detector != detectors[d].component) continue;
            persistent_.push_back({p.a, p.b, {}});
            margin = std::max(margin, contacts_.persistence_margin(p));
        }
        if (persistent_.empty()) continue;
        if (!contacts_.detect(detectors[d], d, persistent_, true, found_, margin)) sort_contacts(found_, step_.world);
        // Both are in the order of pairs.
        auto at = found_.begin();
        for (const PairState& p : island.pairs)
        {
            if (p.detector != detectors[d].component) continue;
            while (at != found_.end() && (at->contact.a != p.a || at->contact.b != p.b)) ++at;
            for (; at != found_.end() && at->contact.a == p.a && at->contact.b == p.b; ++at) note(p, at->contact, out);
        }
    }
}

void SleepingContacts::note(const PairState& pair, const Contact& at, std::vector<LoggedContact>& out) const
{
    for (const KnownContact& k : pair.all())
        if (k.feature == at.feature && (at.depth >= 0 || !(k.impulse == Vec3{})))
            out.push_back(
                {pair.detector, pair.a, pair.b, at.feature, at.point, at.normal, at.depth, k.impulse, 0, step_.frame.step, false});
}

}  // namespace plab::simulation
