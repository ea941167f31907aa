// Exchanging: anything for itself changes no bit, and what the reply calls lost is all that is lost.
#include <map>

#include "subjects.h"

using namespace plab;
using namespace plab::simulation;
using namespace plab::test;

namespace
{

constexpr int kAfterwards = 40;

std::vector<std::string> typed_ids(const Simulation& s)
{
    std::vector<std::string> out;
    for (const std::uint32_t i : s.world().in_id_order())
        if (s.world().type_of(i)) out.push_back(s.world().id_of(i));
    return out;
}

const model::ComponentType& type_of(const Simulation& s, const std::string& id) { return *s.world().type_of(s.world().find(id)); }

Reply exchange(Simulation& s, const std::string& id, const std::string& type, std::vector<NamedValue> values = {})
{
    Request request;
    request.operations = {SwapOperation{id, type, std::move(values)}};
    return s.carry_out_now(request);
}

/// All that a component keeps: parameters and states, by name.
std::map<std::string, Value> values_of(const Simulation& s, const std::string& id)
{
    std::map<std::string, Value> out;
    for (const Field& f : type_of(s, id).schema.fields())
        if (f.kind == FieldKind::Param || f.kind == FieldKind::State) out[f.name] = s.world().get(s.world().find(id), f.name);
    return out;
}

/// What the reply calls lost, as values to give back. False if something is lost that a request cannot give.
bool take_lost(const Reply& reply, const std::map<std::string, Value>& before, std::vector<NamedValue>& out)
{
    for (const TransferredField& f : reply.swaps.at(0).fields)
    {
        if (f.transfer != FieldTransfer::Lost && f.transfer != FieldTransfer::Converted) continue;
        const auto known = before.find(f.field);
        // Contacts that become other ones come back by themselves, those that are lost do not.
        if (known == before.end() && f.transfer == FieldTransfer::Lost) return false;
        if (known != before.end()) out.push_back({f.field, known->second});
    }
    return true;
}

/// A train of gears forgets in which pose its teeth were meshed: the last digit of angles. Where a body's mass properties were
/// other ones in between, or none, its spin is made again from what the author sees: the last digit of momentum.
bool remembers_more(const std::string& type)
{
    return type == "Constraint/AngularVelocity/Graph" || type.rfind("Shape/", 0) == 0 || type == "State/RigidBody";
}

}  // namespace

TEST_CASE("H1: exchanging any component of any scene for itself changes no bit, now or later")
{
    for (const Subject& subject : subjects())
        for (const int start : {1, 37, 100})
        {
            CAPTURE(subject.type);
            CAPTURE(start);
            const model::SceneSpec scene = compiled(subject.blueprint);
            auto alone = started(scene), swapped = started(scene);
            hashes(*alone, start), hashes(*swapped, start);
            for (const std::string& id : typed_ids(*swapped))
            {
                const Reply reply = exchange(*swapped, id, type_of(*swapped, id).info.name);
                CHECK_MESSAGE(reply.done, id, ": ", first_error(reply.errors));
                CHECK_MESSAGE(swapped->state_hash() == alone->state_hash(), id);
            }
            CHECK(first_difference(hashes(*alone, kAfterwards), hashes(*swapped, kAfterwards)) == -1);
        }
}

TEST_CASE("H1: there and back between two steps, with what the reply called lost given back, changes no bit")
{
    std::size_t pairs = 0, refused = 0;
    for (const Subject& subject : subjects())
        for (const std::string& other : library().names())
        {
            const auto type = library().require(other);
            REQUIRE((type.ok() || !is_tested(other)));
            if (!type) continue;
            const model::SceneSpec scene = compiled(subject.blueprint);
            auto alone = started(scene), swapped = started(scene);
            if (other == subject.type || !(*type)->why_not_exchangeable(type_of(*alone, kSubject)).empty()) continue;
            CAPTURE(subject.type);
            CAPTURE(other);
            hashes(*alone, 37), hashes(*swapped, 37);
            const auto before = values_of(*swapped, kSubject);
            const Reply there = exchange(*swapped, kSubject, other);
            if (!there.done)
            {
                ++refused;
                CHECK(swapped->state_hash() == alone->state_hash());
                continue;
            }
            std::vector<NamedValue> lost;
            if (!take_lost(there, before, lost)) continue;
            const Reply back = exchange(*swapped, kSubject, subject.type, lost);
            REQUIRE_MESSAGE(back.done, first_error(back.errors));
            ++pairs;
            CHECK(values_of(*swapped, kSubject) == before);
            if (remembers_more(subject.type)) continue;
            CHECK(swapped->state_hash() == alone->state_hash());
            CHECK(first_difference(hashes(*alone, kAfterwards), hashes(*swapped, kAfterwards)) == -1);
        }
    if (!tests_all_plugins()) return;
    CHECK(pairs > 150);
    CHECK(refused < pairs);  // shapes in a placed one, gaps without rows
}
