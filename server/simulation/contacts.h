/// Contacts over time: who touches since when, under stable ids, whatever detection library found them.
///
/// A pair is known from the step in which it first touches until its gap opens. What the next step depends on (resting,
/// overlap at the start, impulses for warm starts) is state: it is saved, restored and hashed with the scene.
#pragma once

#include <array>
#include <vector>

#include "simulation/group_system.h"

namespace plab::simulation
{

/// A detection component with the algorithms that answer for what it finds.
struct Detector
{
    std::uint32_t component = kNoIndex;
    std::uint32_t table = 0;
    Row row = 0;
    const CommandInfo* command = nullptr;
    std::uint32_t resolution = kNoIndex;  ///< component
    std::uint32_t response = kNoIndex;    ///< component
    bool locates = false, local = false;
    bool responds = false;  ///< the response has a command and takes part
};

/// A contact as found now, with the index of its detector.
struct FoundContact
{
    Contact contact;
    std::uint32_t detector = 0;
};

struct KnownContact
{
    std::uint32_t feature = 0;
    std::uint64_t id = 0;
    Vec3 impulse;  ///< N s per step on b, for warm starts
};

struct PairState
{
    static constexpr std::size_t kMostContacts = 16;

    std::uint32_t detector = kNoIndex;  ///< component
    Ref a, b;
    Tick since = 0;
    bool resting = false;
    bool overlapping = false;  ///< at the end of the last advance: it cannot be bracketed from there
    Vec3 normal;               ///< of the last contact seen, a to b
    std::uint32_t count = 0;
    std::array<KnownContact, kMostContacts> contacts;
};

/// All known pairs, sorted by detector, a and b in id order.
class ContactCache
{
public:
    PairState* find(std::uint32_t detector, Ref a, Ref b, const world::World& world);
    PairState& get_or_add(std::uint32_t detector, Ref a, Ref b, const world::World& world, Tick now, bool& added);
    std::vector<PairState>& pairs() { return pairs_; }
    const std::vector<PairState>& pairs() const { return pairs_; }
    /// The id under which a feature of the pair is known; a new one if it is new.
    KnownContact& contact_of(PairState& pair, std::uint32_t feature);
    /// Drops pairs whose detector or bodies are gone and sorts the rest anew, after a structural change.
    void refresh(const world::World& world, const std::vector<Detector>& detectors);
    void clear() { pairs_.clear(), next_id_ = 1; }
    void save(const world::World& world, ByteWriter& out) const;

private:
    std::vector<PairState> pairs_;
    std::uint64_t next_id_ = 1;
};

/// Detectors of a scene, in id order.
std::vector<Detector> find_detectors(const world::World& world, const Schedule& schedule);

/// Collects what one detector finds.
class ContactCollector final : public ContactSink
{
public:
    ContactCollector(const world::World& world, std::vector<FoundContact>& out) : world_(&world), out_(&out) {}
    void look_for(std::uint32_t detector, std::span<const StandingPair> standing, bool only_standing)
    {
        detector_ = detector, standing_ = standing, only_standing_ = only_standing;
    }
    std::span<const StandingPair> standing() const override { return standing_; }
    bool only_standing() const override { return only_standing_; }
    void add(const Contact& contact) override { out_->push_back({contact, detector_}); }
    bool precedes(Ref a, Ref b) const override { return world_->rank(a) < world_->rank(b); }

private:
    const world::World* world_;
    std::vector<FoundContact>* out_;
    std::uint32_t detector_ = 0;
    std::span<const StandingPair> standing_;
    bool only_standing_ = false;
};

/// By detector, bodies in id order, feature: no library's order reaches the state.
void sort_contacts(std::vector<FoundContact>& contacts, const world::World& world);

/// Overlap that is left alone, m.
inline constexpr double kOverlapTolerance = 1e-9;
/// A standing pair is looked at as if it were this share of its smaller body's radius closer: corners that are about to
/// touch are contacts too, with their gap, and a gap below this does not end the contact.
inline constexpr double kStandingShare = 1e-4;

}  // namespace plab::simulation
