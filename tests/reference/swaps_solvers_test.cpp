// H5: solvers swapped at random steps on the pendulum E1. H6: a request that comes while an impact is located.
#include "plab/random.h"
#include "swaps.h"

using namespace plab;
using namespace plab::simulation;
using namespace plab::test;

namespace
{

/// E1: 1 kg at 1 m, released horizontally; its position after 10 s (mpmath, elliptic functions, 40 digits).
constexpr double kX = -.275087462576116860, kY = -.961419205099125064;

std::string pendulum(const std::string& joint_type, const std::string& solver)
{
    return solver_is(solver) + gravity() + body("bob", 1, {1e-3, 1e-3, 1e-3}, {1, 0, 0}, "solver='solver'") +
           joint("joint", joint_type, "", "bob", "anchor='0 0 0'" + std::string(joint_type == "Hinge" ? " axis='0 1 0'" : ""));
}

/// A point mass: under a ball joint the bob does not rotate about its own centre, as no torque acts on it.
double error_of(const Scene& s)
{
    const Vec3 p = s.vec("bob", "position");
    return std::hypot(p.x - kX, p.z - kY);
}

double error_alone(const std::string& solver, int per_second)
{
    Scene s(pendulum("Hinge", solver), dt(per_second));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = true;  // Exact reports the method to which it falls back
    s.run(10);
    return error_of(s);
}

/// A resolution that halves as Resolution/LocalBisection does, and posts a request in the middle of it.
struct PostingRows
{
    void describe(Schema&) {}
};
Simulation* posts_to = nullptr;
const Request* posted = nullptr;
int trials = 0;

void bisect_and_post(const StepContext&, Row, const PostingRows&, EventBracket& trial)
{
    ++trials;
    if (posts_to && trial.iteration == 5) std::exchange(posts_to, nullptr)->post(*posted);
    const double middle = 0.5 * (trial.begin + trial.end);
    trial.decision = trial.end - trial.begin <= 1e-12 ? EventBracket::Decision::Accept : EventBracket::Decision::Try;
    trial.next = middle;
}

/// All types of this build and the one above.
class WithPosting final : public model::TypeSource
{
public:
    WithPosting()
    {
        Registrar registrar;
        registrar.component<PostingRows>("Resolution/Posting", "halves, and posts a request meanwhile")
            .command<bisect_and_post>(Phase::Locate, "Resolution/Locate", "halves the bracket")
            .locates()
            .local();
        REQUIRE(own_.add(std::move(registrar), "test").ok());
    }
    Result<const model::ComponentType*> require(const std::string& name) override
    {
        if (const model::ComponentType* type = own_.find(name)) return type;
        return library().require(name);
    }
    std::vector<std::string> names() const override { return library().names(); }

private:
    model::TypeRegistry own_;
};

std::unique_ptr<Simulation> bouncing(model::TypeSource& types)
{
    const std::string scene = "<plab version='1'><scene dt='1/60'/>" + gravity() + solid("a", "Sphere' radius='0.1'", 1, {0, 0, 0.5}) +
                              solid("b", "Box' half_extents='0.1 0.1 0.1'", 1, {1, 0, 0.4}, "angular_velocity='1 2 3'") +
                              ground_and_contact("Posting", "Impulse", "response.restitution='0.7'") + "</plab>";
    auto blueprint = blueprint::read_blueprint(scene, "scene.xml");
    REQUIRE(blueprint.ok());
    auto compiled = model::compile(*blueprint, types);
    REQUIRE_MESSAGE(compiled.ok(), (compiled.ok() ? "" : first_error(compiled.errors())));
    auto out = std::make_unique<Simulation>(types);
    REQUIRE(out->load(*compiled).ok());
    return out;
}

}  // namespace

TEST_CASE("H5: any two solvers swapped at random steps on the pendulum: the error is at most twice the larger one of the two")
{
    constexpr int kPerSecond = 100;
    std::vector<double> alone;
    for (const std::string& solver : solvers()) alone.push_back(error_alone(solver, kPerSecond));
    std::uint64_t seed = 5;
    for (std::size_t i = 0; i < solvers().size(); ++i)
        for (std::size_t k = 0; k < solvers().size(); ++k)
        {
            if (i == k) continue;
            CAPTURE(solvers()[i]);
            CAPTURE(solvers()[k]);
            Scene s(pendulum("Hinge", solvers()[i]), dt(kPerSecond));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.warnings_expected = true;
            bool first = true;
            for (std::int64_t left = 10 * kPerSecond; left > 0;)
            {
                const auto n = std::min<std::int64_t>(left, 50 + static_cast<std::int64_t>(next_random(seed) % 400));
                s.step(n);
                left -= n;
                first = !first;
                swapped(s, "solver", "Solver/" + solvers()[first ? i : k]);
            }
            CHECK(error_of(s) <= 2 * std::max({alone[i], alone[k], 1e-12}));
            CHECK(s.real("joint", "position_error") <= 1e-12);
        }
}

TEST_CASE("a joint exchanged during the motion: ball, hinge, fixed, removed")
{
    // In the plane, all joints that allow it to swing are equivalent.
    Scene s(pendulum("Ball", "RungeKutta4"), dt(1000)), hinge(pendulum("Hinge", "RungeKutta4"), dt(1000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1), hinge.run(1);
    const Totals before = s.simulation().totals();
    const Reply reply = swapped(s, "joint", "Constraint/Hinge", {{"axis", std::string("0 1 0")}});
    CHECK(transfer_of(reply, "point_a") == "kept");
    CHECK(transfer_of(reply, "axis") == "given");
    CHECK(transfer_of(reply, "frame_a") == "fresh");
    CHECK(s.simulation().totals().kinetic == before.kinetic);
    CHECK(s.simulation().totals().momentum == before.momentum);
    s.run(10);
    CHECK(s.real("joint", "position_error") <= 1e-12);
    // Fixed: it does not move from then on; the energy of the impact is in the ledger.
    const Reply fixed = swapped(s, "joint", "Constraint/Fixed");
    CHECK(transfer_of(fixed, "axis") == "lost");
    s.step();
    const Vec3 held = s.vec("bob", "position");
    s.run(11);
    CHECK(distance(s.vec("bob", "position"), held) <= 1e-12);
    CHECK(length(s.vec("bob", "linear_velocity")) <= 1e-12);
    const Totals t = s.simulation().totals();
    CHECK(std::fabs(t.kinetic - s.simulation().kinetic_at_start() - t.work) <= 1e-8);
    // Removed: it falls.
    REQUIRE(s.ask(RemoveOperation{"joint"}).done);
    s.run(12);
    CHECK(near(s.vec("bob", "position").z, held.z - 0.5 * 9.81, 1e-9));
}

TEST_CASE("H6: a request that comes while an impact is located waits for the boundary, bit for bit")
{
    WithPosting types;
    for (const Operation& operation :
         {Operation(SwapOperation{"contact.response", "Response/None", {}}),
          Operation(SwapOperation{"contact.resolution", "Resolution/LocalRoot", {}}),
          Operation(SwapOperation{"contact.response", "Response/Penalty", {}}), Operation(RemoveOperation{"g"})})
    {
        Request request;
        request.operations = {operation};
        auto during = bouncing(types), after = bouncing(types);
        trials = 0;
        Tick hit = 0;
        posts_to = during.get(), posted = &request;
        while (posts_to) during->step(), ++hit;
        REQUIRE(trials > 5);
        CHECK(during->take_replies().empty());
        Simulation* none = nullptr;
        posts_to = none;
        for (Tick i = 0; i < hit; ++i) after->step();
        // The request has not affected the step with the impact.
        CHECK(during->state_hash() == after->state_hash());
        REQUIRE(after->carry_out_now(request).done);
        for (int i = 0; i < 60; ++i)
        {
            during->step(), after->step();
            CHECK(during->state_hash() == after->state_hash());
        }
        const auto replies = during->take_replies();
        REQUIRE(replies.size() == 1);
        CHECK(replies[0].done);
        CHECK(replies[0].step == hit);
    }
}
