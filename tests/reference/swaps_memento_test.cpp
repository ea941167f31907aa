// What a step depends on is in the memento also where contacts remember: stiction springs, warm starts, overlap that a swap left.
#include "swaps.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// A world with its stepper, without Simulation around them.
class Run
{
public:
    explicit Run(const std::string& text) : world_(library())
    {
        auto blueprint = blueprint::read_blueprint("<plab version='1'>" + text + "</plab>", "scene.xml");
        REQUIRE(blueprint.ok());
        auto scene = model::compile(*blueprint, library());
        REQUIRE_MESSAGE(scene.ok(), (scene.ok() ? "" : first_error(scene.errors())));
        world_.describe(scene->settings, scene->file);
        REQUIRE(world_.add(*scene).ok());
        stepper_ = std::make_unique<simulation::Stepper>(world_, 1);
        REQUIRE(stepper_->rebuild().ok());
    }
    struct Memento
    {
        Tick tick;
        world::Backup world;
        simulation::ContactCache contacts;
    };
    Memento save() const { return {tick_, world_.backup(), stepper_->contacts()}; }
    void restore(const Memento& m)
    {
        tick_ = m.tick;
        world_.restore(m.world);
        stepper_->contacts() = m.contacts;
    }
    std::vector<std::uint64_t> advance(int steps)
    {
        std::vector<std::uint64_t> out;
        for (int i = 0; i < steps; ++i, ++tick_)
        {
            stepper_->step(tick_, static_cast<double>(tick_) / 60, 1.0 / 60);
            out.push_back(stepper_->state_hash());
        }
        return out;
    }
    std::size_t remembered() const
    {
        std::size_t n = 0;
        for (const simulation::ForcePair& p : stepper_->contacts().force_pairs())
            for (const simulation::ForceContact& c : p.all()) n += c.stretch != Vec3{} ? 1 : 0;
        for (const simulation::PairState& p : stepper_->contacts().pairs())
            for (std::uint32_t k = 0; k < p.count; ++k) n += p.contacts[k].impulse != Vec3{} ? 1 : 0;
        return n;
    }

private:
    Tick tick_ = 0;
    world::World world_;
    std::unique_ptr<simulation::Stepper> stepper_;
};

/// Boxes that lean on friction: gravity is not square to the floor.
std::string leaning(const std::string& resolution, const std::string& response, const std::string& more)
{
    return gravity("2 1 -9.6") + solid("low", "Box' half_extents='0.2 0.2 0.1'", 2, {0, 0, 0.1}) +
           solid("high", "Box' half_extents='0.1 0.1 0.1'", 1, {0.02, 0.03, 0.3}) +
           solid("roller", "Sphere' radius='0.1'", 1, {1, 0, 0.1}, "linear_velocity='0.3 0.1 0'") +
           ground_and_contact(resolution, response, more);
}

}  // namespace

TEST_CASE("a memento of leaning boxes is all there is, on springs and on rows, also in a world that never ran")
{
    const std::string soft = "response.friction='0.6' response.stiffness='1e4' response.restitution='0.2' response.steps_per_contact='20'";
    std::vector<std::string> scenes{leaning("None", "Penalty", soft), leaning("None", "HuntCrossley", soft),
                                    leaning("LocalBisection", "Impulse", "response.friction='0.6'")};
    for (const std::string& manager : managers())
        for (const char* resolution : {"None", "LocalBisection"})
            scenes.push_back(leaning(resolution, "Rows", "response.friction='0.6' response.manager='Manager/" + manager + "'"));
    for (const std::string& scene : scenes)
    {
        CAPTURE(scene);
        Run run(scene), fresh(scene);
        run.advance(30);
        CHECK(run.remembered() >= 4);
        const Run::Memento memento = run.save();
        const auto first = run.advance(15);
        run.restore(memento);
        CHECK(run.advance(15) == first);
        fresh.restore(memento);
        CHECK(fresh.advance(15) == first);
    }
}
