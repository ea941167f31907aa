/// Contacts over time: which pairs touch since when, under stable ids, whatever detection library found them.
///
/// A pair is known from the step in which it first touches until its gap opens. If it stays in contact without bouncing, it is persistent
/// (`resting`). Everything that the next step depends on (resting, overlap at the start, impulses for warm starts) is state: it is saved,
/// restored and hashed with the scene.
#pragma once

#include <algorithm>
#include <compare>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "simulation/contacts/contact_force_pair.h"
#include "simulation/contacts/point_block.h"
#include "simulation/contacts/rest_state.h"
#include "simulation/systems/group_system.h"

namespace plab::simulation
{

/// A number that a component declares under some name. It is found once, when the scene changes; a step then reads it without a search.
class DeclaredNumber
{
public:
    DeclaredNumber() = default;
    /// Nothing is declared where `component` is kNoIndex or has no such parameter.
    DeclaredNumber(const world::World& world, std::uint32_t component, std::string_view name);
    double value_or(double otherwise) const
    {
        if (real_) return (*real_)[row_];
        return whole_ ? static_cast<double>((*whole_)[row_]) : otherwise;
    }

private:
    const Column<double>* real_ = nullptr;
    const Column<std::int64_t>* whole_ = nullptr;
    Row row_ = 0;
};

/// A detection component with the algorithms that handle what it finds: its resolution and its response.
struct Detector
{
    std::uint32_t component = kNoIndex;
    std::uint32_t table = 0;
    Row row = 0;
    const CommandInfo* command = nullptr;
    std::uint32_t resolution = kNoIndex;  ///< component
    std::uint32_t response = kNoIndex;    ///< component
    std::uint32_t manager = kNoIndex;     ///< component; for a response by rows
    const CommandInfo* gap = nullptr;     ///< command that measures the gap of two bodies; null: it has none
    bool adapts = false;                  ///< the resolution chooses the next five for each step (ContactBook::choose_search)
    bool spares_crowds = false;           ///< what it locates does not hold for pairs with a crowded body (ContactBook::locates)
    bool locates = false, local = false;
    bool certifies = false;                              ///< the resolution uses motion bounds: no impact inside the step is missed
    bool speculates = false;                             ///< gaps that may close within the step count as contacts, with depth < 0
    bool responds = false;                               ///< the response has a command for impacts and takes part
    bool by_rows = false;                                ///< the response leaves contacts to a manager
    bool by_force = false;                               ///< the response is a force
    DeclaredNumber friction, restitution;                ///< of the response; materials may have their own
    DeclaredNumber rolling_friction, spinning_friction;  ///< likewise
    DeclaredNumber steps_per_contact, steps_among_many;  ///< of a response that is a force
    DeclaredNumber max_substeps;                         ///< likewise
    DeclaredNumber speculation_acceleration;             ///< m/s^2, of a resolution that speculates
    DeclaredNumber max_work, base_work;                  ///< of a resolution that locates
    DeclaredNumber max_bodies, max_points, dwell;        ///< of one that adapts: limits of crowds
    /// Contacts are not events: each touching pair is persistent at once, and a manager or a force handles it.
    bool persists() const { return by_force || (by_rows && !locates); }
    /// The same, of some pairs.
    bool may_persist() const { return persists() || (by_rows && spares_crowds); }
};

/// A contact as found now, with the index of its detector.
struct FoundContact
{
    FoundContact() = default;
    FoundContact(const Contact& at, std::uint32_t by) : contact(at), detector(by) {}

    Contact contact;
    std::uint32_t detector = 0;
    /// Where its pair kept it last: a place in PairState::contacts, at which contact_of() looks first.
    std::uint32_t slot = 0;
};

inline bool same_pair(const FoundContact& x, const FoundContact& y)
{
    return x.detector == y.detector && x.contact.a == y.contact.a && x.contact.b == y.contact.b;
}

/// The last impacts of a pair, to predict where a sequence of bounces ends (zeno.h).
struct BounceHistory
{
    double time = 0;      ///< s, of the last impact
    double interval = 0;  ///< s, between the last two; 0: none yet
    double previous = 0;  ///< s, the interval before
    friend bool operator==(const BounceHistory&, const BounceHistory&) = default;
};

/// A pair: everything but its contacts.
struct PairHead
{
    std::uint32_t detector = kNoIndex;  ///< component
    Ref a, b;
    Tick since = 0;
    bool resting = false;
    bool ahead = false;        ///< does not touch: a gap that may close within the step (Resolution/Speculative); solved, but not reported
    bool overlapping = false;  ///< at the end of the last advance: there is no clear side to bracket from
    Vec3 normal;               ///< of the contact detected last, a to b
    std::uint32_t count = 0;   ///< number of its contacts
    BounceHistory bounces;
    std::uint32_t impacts = 0;  ///< number of impacts in the step `impacts_tick`; not hashed: a step begins with none
    Tick impacts_tick = -1;
    Tick paradox_tick = -2;     ///< last step with Painleve's paradox at this pair; not hashed either
    double pressed_before = 0;  ///< N s, in the step before `pressed_tick`; not hashed: each step finds it itself
    Tick pressed_tick = -1;
    static constexpr std::uint32_t kNoRelease = UINT32_MAX;
    std::uint32_t release = kNoRelease;  ///< index of its release among those noted in the step `pressed_tick`
};

struct PairState : PairHead
{
    static constexpr std::uint32_t kMostContacts = PointBlock::kMost;

    PairState() = default;
    PairState(PairState&&) noexcept = default;
    PairState& operator=(PairState&&) noexcept = default;
    PairState(const PairState& other) : PairHead(other) { copy_contacts(other); }
    PairState& operator=(const PairState& other)
    {
        if (this == &other) return *this;
        PairHead::operator=(other);
        copy_contacts(other);
        return *this;
    }

    PointBlock contacts;  ///< the first `count` are in use

    /// For loops over pairs, which come to blocks in no order of memory: asks for the block of a pair this many places ahead.
    static constexpr std::size_t kAhead = 6;
    void prefetch() const
    {
        for (std::uint32_t i = 0; i < count; ++i) __builtin_prefetch(contacts.begin() + i);
    }

    std::span<KnownContact> all() { return {contacts.begin(), count}; }
    std::span<const KnownContact> all() const { return {contacts.begin(), count}; }
    /// Adds a contact with default values; there must be fewer than kMostContacts.
    KnownContact& add()
    {
        contacts.reserve(count + 1, count);
        return contacts[count++] = {};
    }

private:
    void copy_contacts(const PairState& other)
    {
        contacts.reserve(other.count, 0);
        std::copy_n(other.contacts.begin(), other.count, contacts.begin());
    }
};

/// Where a pair stands in the order of pairs: ranks of its detector and bodies.
struct PairKey
{
    PairKey() = default;
    PairKey(const world::World& world, std::uint32_t of_detector, Ref of_a, Ref of_b)
        : detector(world.rank(of_detector)), a(world.rank(of_a)), b(world.rank(of_b))
    {
    }
    std::uint32_t detector = 0, a = 0, b = 0;
    friend auto operator<=>(const PairKey&, const PairKey&) = default;
};

/// The contacts of a pair in a sorted list of contacts.
struct FoundRun
{
    std::uint32_t first = 0, end = 0;
    PairKey key;
};

/// All known pairs, sorted by detector, a and b in id order. Searches read a list of keys (12 bytes a pair) that always corresponds to
/// the pairs one to one, so pairs are added and dropped through this class only. Blocks of points that pairs leave behind are reused, so
/// that contacts that begin and end in a warm step allocate nothing.
class ContactCache
{
public:
    PairState* find(std::uint32_t detector, Ref a, Ref b, const world::World& world);
    /// The same, faster for whoever asks for pairs in the order of pairs(), or nearly so: `near` is where the last one was, 0 at first.
    PairState* find(std::uint32_t detector, Ref a, Ref b, const world::World& world, std::size_t& near);
    const PairState* find(std::uint32_t detector, Ref a, Ref b, const world::World& world, std::size_t& near) const;
    PairState& get_or_add(std::uint32_t detector, Ref a, Ref b, const world::World& world, Tick now, bool& added);
    /// Adds pairs that are not known yet and have no contacts, in one pass. `fresh` is sorted like pairs().
    void add_sorted(std::span<const PairState> fresh, const world::World& world);
    void erase(PairState& pair);
    /// Asks ends(pair) or ends(pair, key) once for each pair, in order, and drops those for which it is true.
    template <class Ends>
    void drop_if(Ends ends);
    /// Takes pairs in any order in place of the present ones.
    void assign(std::vector<PairState> pairs, const world::World& world);
    std::span<PairState> pairs() { return pairs_; }
    const std::vector<PairState>& pairs() const { return pairs_; }
    /// Of each of pairs(), in the same order.
    std::span<const PairKey> keys() const { return keys_; }
    /// The known contact of a feature of the pair; added with a new id if the feature is new. `slot`: where it may be.
    KnownContact& contact_of(PairState& pair, std::uint32_t feature, std::uint32_t slot = 0)
    {
        if (slot < pair.count && pair.contacts[slot].feature == feature) return pair.contacts[slot];
        return search_contact(pair, feature);
    }
    /// The same; `found` notes the place.
    KnownContact& contact_of(PairState& pair, FoundContact& found)
    {
        KnownContact& known = contact_of(pair, found.contact.feature, found.slot);
        found.slot = static_cast<std::uint32_t>(&known - pair.contacts.begin());
        return known;
    }
    /// Null if the pair or the feature is not known.
    const KnownContact* find_contact(std::uint32_t detector, Ref a, Ref b, std::uint32_t feature, const world::World& world);
    /// To be called after a structural change: drops pairs whose detector or bodies are gone, and sorts the rest again.
    void refresh(const world::World& world, const std::vector<Detector>& detectors);
    void clear() { *this = {}; }
    /// Copies `from`, except contact slots that are not in use, and keeps this cache's memory.
    void copy(const ContactCache& from);
    /// The same for the pairs whose key `keep` accepts, and the pairs with force contacts whose bodies `keep_forces` accepts.
    template <class Keep, class KeepForces>
    void copy_if(const ContactCache& from, Keep keep, KeepForces keep_forces);
    std::uint64_t new_id() { return next_id_++; }
    std::uint64_t next_id() const { return next_id_; }
    /// Lets ids continue from those of a snapshot.
    void continue_ids(std::uint64_t next) { next_id_ = next; }
    /// False if it is certain that no contact has a rest_depth. Only swaps and restored states bring one in.
    bool may_have_rest_depth() const { return may_have_rest_depth_; }
    /// To be called by whoever has seen that no contact has one.
    void has_no_rest_depth() { may_have_rest_depth_ = false; }
    /// Pairs with force contacts, in the same order.
    std::vector<ForcePair>& force_pairs() { return force_pairs_; }
    const std::vector<ForcePair>& force_pairs() const { return force_pairs_; }
    /// Pairs as they were before a swap converted them at the present step boundary: swapping back restores them.
    std::vector<PairState>& parked_pairs() { return parked_pairs_; }
    const std::vector<PairState>& parked_pairs() const { return parked_pairs_; }
    std::vector<ForcePair>& parked_force_pairs() { return parked_force_pairs_; }
    const std::vector<ForcePair>& parked_force_pairs() const { return parked_force_pairs_; }
    void forget_parked() { parked_pairs_.clear(), parked_force_pairs_.clear(); }
    /// Which bodies rest, and the pairs of islands that sleep: missing in pairs() until bring_back(), and last in each_pair().
    RestState& rest() { return rest_; }
    const RestState& rest() const { return rest_; }
    /// s, by host row: Crowds::find().
    std::vector<double>& crowded_until() { return crowded_until_; }
    const std::vector<double>& crowded_until() const { return crowded_until_; }
    void bring_back(const world::World& world);
    void each_pair(const auto& job) const;  // sleeping_pairs.h
    /// Hash of everything that later steps depend on, mixed into `start`.
    std::uint64_t state_hash(const world::World& world, std::uint64_t start) const;

private:
    std::size_t place_of(const PairKey& key) const;
    KnownContact& search_contact(PairState& pair, std::uint32_t feature);
    bool is_at(std::size_t place, const PairKey& key) const { return place < keys_.size() && keys_[place] == key; }
    void sort(const world::World& world);
    void shrink(std::size_t size);

    std::vector<PairState> pairs_, parked_pairs_;
    std::vector<PairKey> keys_;  ///< of pairs_
    PointPool pool_;
    std::vector<ForcePair> force_pairs_, parked_force_pairs_;
    std::uint64_t next_id_ = 1;
    bool may_have_rest_depth_ = true;
    RestState rest_;
    std::vector<double> crowded_until_;
};

template <class Ends>
void ContactCache::drop_if(Ends ends)
{
    std::size_t kept = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i)
    {
        if (i + PairState::kAhead < pairs_.size()) pairs_[i + PairState::kAhead].prefetch();
        if constexpr (std::is_invocable_v<Ends, PairState&, const PairKey&>)
        {
            if (ends(pairs_[i], keys_[i])) continue;
        }
        else if (ends(pairs_[i]))
            continue;
        // The blocks of pairs that are dropped gather behind the others (PointBlock::operator=).
        if (kept != i) pairs_[kept] = std::move(pairs_[i]), keys_[kept] = keys_[i];
        ++kept;
    }
    shrink(kept);
}

template <class Keep, class KeepForces>
void ContactCache::copy_if(const ContactCache& from, Keep keep, KeepForces keep_forces)
{
    clear();
    for (std::size_t i = 0; i < from.keys_.size(); ++i)
        if (keep(from.keys_[i])) pairs_.push_back(from.pairs_[i]), keys_.push_back(from.keys_[i]);
    for (const ForcePair& p : from.force_pairs_)
        if (keep_forces(p.a, p.b)) force_pairs_.push_back(p);
    parked_pairs_ = from.parked_pairs_, parked_force_pairs_ = from.parked_force_pairs_;
    next_id_ = from.next_id_, may_have_rest_depth_ = from.may_have_rest_depth_;
    rest_ = from.rest_, crowded_until_ = from.crowded_until_;
}

/// Detectors of a scene, in id order.
std::vector<Detector> find_detectors(const world::World& world, const Schedule& schedule);

/// Whether x comes before y in the order of contacts: by detector, bodies in id order, and feature.
inline bool precedes(const FoundContact& x, const FoundContact& y, const world::World& world)
{
    if (same_pair(x, y)) return x.contact.feature < y.contact.feature;
    if (x.detector != y.detector) return x.detector < y.detector;
    const std::uint32_t xa = world.rank(x.contact.a), ya = world.rank(y.contact.a);
    return xa != ya ? xa < ya : world.rank(x.contact.b) < world.rank(y.contact.b);
}

/// Collects what one detector finds.
class ContactCollector : public ContactSink
{
public:
    ContactCollector(const world::World& world, std::vector<FoundContact>& out) : world_(&world), out_(&out) {}
    void begin_query(std::uint32_t detector, std::span<const PersistentPair> persistent, bool only_persistent, double margin = 0)
    {
        detector_ = detector, persistent_ = persistent, only_persistent_ = only_persistent, margin_ = margin;
    }
    std::span<const PersistentPair> persistent() const override { return persistent_; }
    bool only_persistent() const override { return only_persistent_; }
    double margin() const override { return margin_; }
    bool level_rims() const override { return level_rims_; }
    void want_level_rims() { level_rims_ = true; }
    void add(const Contact& contact) override
    {
        const FoundContact& last = put(contact);
        if (out_->size() > 1 && simulation::precedes(last, *(&last - 1), *world_)) in_order_ = false;
    }
    bool precedes(Ref a, Ref b) const override { return world_->rank(a) < world_->rank(b); }
    void took(double further_pairs) override { further_pairs_ += further_pairs; }
    double further_pairs() const { return further_pairs_; }
    /// Whether what was added is sorted, also behind what was there before.
    bool in_order() const { return in_order_; }

protected:
    /// Adds what a detection fills in.
    FoundContact& put(const Contact& from)
    {
        FoundContact& f = out_->emplace_back();
        // Asks for the memory of a contact that will be added later.
        const char* const ahead = reinterpret_cast<const char*>(&f) + 8 * sizeof f;
        for (std::size_t i = 0; i < sizeof f; i += 64) __builtin_prefetch(ahead + i, 1);
        Contact& c = f.contact;
        c.a = from.a, c.b = from.b, c.feature = from.feature, c.point = from.point, c.normal = from.normal, c.depth = from.depth;
        c.pivot = from.pivot;
        f.detector = detector_;
        return f;
    }

    const world::World* world_;
    std::vector<FoundContact>* out_;
    bool in_order_ = true;

private:
    double further_pairs_ = 0;
    std::uint32_t detector_ = 0;
    std::span<const PersistentPair> persistent_;
    bool only_persistent_ = false, level_rims_ = false;
    double margin_ = 0;
};

/// Collects the pairs that may meet, given each body's motion margin, by which its AABB is expanded.
class NearCollector final : public ContactSink
{
public:
    struct Pair
    {
        Ref a, b;
    };
    NearCollector(const world::World& world, std::span<const double> motion_margin, std::vector<Pair>& out)
        : world_(&world), motion_margin_(motion_margin), out_(&out)
    {
    }
    std::span<const PersistentPair> persistent() const override { return {}; }
    std::span<const double> motion_margin() const override { return motion_margin_; }
    void near(Ref a, Ref b) override { out_->push_back({a, b}); }
    void add(const Contact&) override {}
    bool precedes(Ref a, Ref b) const override { return world_->rank(a) < world_->rank(b); }

private:
    const world::World* world_;
    std::span<const double> motion_margin_;
    std::vector<Pair>* out_;
};

/// Sorts by precedes(), so that the order in which a library reports contacts does not affect the state.
void sort_contacts(std::vector<FoundContact>& contacts, const world::World& world);

/// N s: sum of the normal impulses of a pair in the last advance.
double pressed_with(const PairState& pair);
/// Whether a persistent pair had a pressing impulse in the last step.
bool pressed(const PairState& pair);

/// 1/kg: effective inverse mass of a body at p (W, m) along n: the velocity change there by a unit impulse.
double mobility_at(const Bodies& bodies, std::uint32_t b, const Vec3& p, const Vec3& n);

/// m: the smallest radius of gyration, sqrt(tr I / 2m), of the dynamic ones among some bodies; 0 if there are none. It serves as the
/// length scale of tolerances.
double least_gyration(const Bodies& bodies, std::span<const std::uint32_t> some);

/// Overlap that is not corrected, as a fraction of the smaller body's radius.
inline constexpr double kOverlapShare = 1e-8;
/// A contact that closes by less than this fraction of the radius of gyration per step is not an impact.
inline constexpr double kNoApproach = 0x1p-34;
/// A pair is released if it separates faster than this fraction of the speed that its impulse took away in the last step. Slower motion is
/// jitter.
inline constexpr double kParts = 0x1p-24;
/// Persistence margin as a fraction of the smaller body's radius. Persistent pairs are detected with this margin: corners that are about to
/// touch are contacts too, with their gap, and a gap below the margin does not end the contact.
inline constexpr double kPersistenceShare = 1e-4;

}  // namespace plab::simulation
