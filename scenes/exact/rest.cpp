// Resting boxes: stacked flat on level ground, they do not move.
#include <algorithm>
#include <cmath>

#include "exact/facts.h"

namespace plab::exact
{
namespace
{

class Rest final : public Solution
{
public:
    explicit Rest(std::map<std::string, State> places) : places_(std::move(places)) {}
    bool state(const std::string& id, double, State& out) const override
    {
        const auto found = places_.find(id);
        if (found == places_.end()) return false;
        out = found->second;
        return true;
    }
    std::string words() const override
    {
        return "statics: " + std::to_string(places_.size()) + (places_.size() == 1 ? " body stays" : " bodies stay") + " where put";
    }

private:
    std::map<std::string, State> places_;
};

/// A box with faces along the world's axes.
struct Block
{
    std::uint32_t id;
    Vec3 center, half, mass_center;
};

Result<Block> block_of(const SceneFacts& facts, std::uint32_t i)
{
    const auto box = only_shape(facts, i, GeometryKind::Box, "box");
    if (!box) return box.errors();
    const std::uint32_t row = facts.world().component(i).host_index;
    const Bodies& bodies = facts.bodies();
    const Pose pose = bodies.pose(row) * box->pose;
    if (length(rotate(pose.q, Vec3{0, 0, 1}) - Vec3{0, 0, 1}) > 1e-12 || length(rotate(pose.q, Vec3{1, 0, 0}) - Vec3{1, 0, 0}) > 1e-12)
        return reason(facts.world().id_of(i) + " is turned; this form is about boxes along the axes");
    if (length(bodies.velocity[row]) > 0 || length(bodies.angular_velocity[row]) > 0) return reason(facts.world().id_of(i) + " moves");
    return Block{i, pose.p, box->size, bodies.position[row]};
}

bool lies_on(const Block& upper, const Block& lower)
{
    const double gap = upper.center.z - upper.half.z - lower.center.z - lower.half.z;
    return std::fabs(gap) < 1e-9 * (upper.half.z + lower.half.z) &&
           std::fabs(upper.center.x - lower.center.x) < upper.half.x + lower.half.x &&
           std::fabs(upper.center.y - lower.center.y) < upper.half.y + lower.half.y;
}

/// Tops of all level planes that do not move.
Result<std::vector<double>> grounds_of(const SceneFacts& facts)
{
    std::vector<double> out;
    const world::HostTables& host = facts.world().host();
    for (const std::uint32_t i : facts.world().in_id_order())
    {
        const world::Component& c = facts.world().component(i);
        if (c.facet != Facet::Body || host.bodies.dynamic(c.host_index)) continue;
        for (const Ref shape : host.bodies.shapes[c.host_index])
        {
            const Geometry& form = host.shapes.geometry[shape.index];
            const Pose pose = host.bodies.pose(c.host_index) * form.pose;
            if (form.kind != GeometryKind::Plane || !(rotate(pose.q, Vec3{0, 0, 1}) == Vec3{0, 0, 1}))
                return reason(c.id + " is not a horizontal plane");
            out.push_back(pose.p.z);
        }
    }
    return out;
}

/// The weight of `upper` and of everything above must act within its support, which is one block or the ground.
Result<void> check_stands(const SceneFacts& facts, const Block& block, const std::vector<Block>& all, const std::vector<double>& grounds)
{
    const std::string id = facts.world().id_of(block.id);
    const Block* support = nullptr;
    for (const Block& other : all)
        if (other.id != block.id && lies_on(block, other))
        {
            if (support) return reason(id + " lies on two others; this form is about columns");
            support = &other;
        }
    const double bottom = block.center.z - block.half.z;
    const bool on_ground =
        std::any_of(grounds.begin(), grounds.end(), [&](double z) { return std::fabs(z - bottom) < 1e-9 * block.half.z; });
    if (!support && !on_ground) return reason(id + " is not supported");
    // For each block, as long as something rests on it: the common centre of mass of everything above must be over the support.
    double mass = 0;
    Vec3 sum;
    for (const Block* now = &block; now;)
    {
        const double m = facts.bodies().mass[facts.world().component(now->id).host_index];
        mass += m, sum += now->mass_center * m;
        const auto above = std::find_if(all.begin(), all.end(), [&](const Block& b) { return b.id != now->id && lies_on(b, *now); });
        now = above == all.end() ? nullptr : &*above;
    }
    const Vec3 center = sum / mass;
    const Vec3 low = support ? Vec3{std::max(block.center.x - block.half.x, support->center.x - support->half.x),
                                    std::max(block.center.y - block.half.y, support->center.y - support->half.y), 0}
                             : block.center - block.half;
    const Vec3 high = support ? Vec3{std::min(block.center.x + block.half.x, support->center.x + support->half.x),
                                     std::min(block.center.y + block.half.y, support->center.y + support->half.y), 0}
                              : block.center + block.half;
    if (center.x < low.x || center.x > high.x || center.y < low.y || center.y > high.y) return reason(id + " topples");
    return {};
}

}  // namespace

Result<std::unique_ptr<Solution>> make_rest(const SceneFacts& facts, double)
{
    if (!facts.collides()) return reason("nothing collides: it has no CDetection/...");
    if (const std::string other = facts.foreign_force({"Field/Gravity"}); !other.empty())
        return reason(other + " acts too; only Field/Gravity may");
    const Vec3 g = facts.gravity();
    if (!(g.x == 0 && g.y == 0 && g.z < 0)) return reason("gravity is not along -z");
    std::vector<Block> blocks;
    for (const std::uint32_t i : facts.dynamic(Facet::Body))
    {
        const auto block = block_of(facts, i);
        if (!block) return block.errors();
        blocks.push_back(*block);
    }
    if (blocks.empty()) return reason("it has no moving body");
    const auto grounds = grounds_of(facts);
    if (!grounds) return grounds.errors();
    std::map<std::string, State> places;
    for (const Block& block : blocks)
    {
        if (auto stands = check_stands(facts, block, blocks, *grounds); !stands) return stands.errors();
        places[facts.world().id_of(block.id)] = present(facts, block.id);
    }
    return std::unique_ptr<Solution>(std::make_unique<Rest>(std::move(places)));
}

}  // namespace plab::exact
