// Speed against a thin wall, for each resolution with each kind of response that can be combined with it.
#include "case.h"
#include "pieces.h"
#include "trial.h"

namespace plab::stability
{

namespace
{

const std::vector<double> kSpeeds{1, 1e2, 1e3, 1e4};

struct Algorithm
{
    std::string name;
    ContactAlgorithm contact;
};

std::vector<Algorithm> algorithms()
{
    std::vector<Algorithm> out;
    for (const std::string& resolution : algorithms_of("Resolution"))
    {
        if (resolution != "Speculative") out.push_back({resolution + ", Impulse", {"", "Impulse", resolution, ""}});
        out.push_back({resolution + ", Rows", {"", "Rows", resolution, "Direct"}});
    }
    out.push_back({"Penalty", {"", "Penalty", "", ""}});
    out.push_back({"HuntCrossley", {"", "HuntCrossley", "", ""}});
    return out;
}

Case wall(bool spins)
{
    const auto all = algorithms();
    std::vector<std::string> names;
    for (const Algorithm& r : all) names.push_back(r.name);
    Case c{spins ? "wall_corner" : "wall",
           spins ? "A spinning box against a thin wall" : "A ball against a thin wall",
           spins ? "A box of 1 m x 2 cm x 2 cm rotates with the given speed, in rad/s, 0.3 m from a wall of 1 cm; 0.1 s at 1/60 s. "
                   "Restitution 1, no weight. Within a step its ends would pass through the wall and back many times. "
                   "Algorithms that test only the ends of a step can miss a corner: None, the bisections and springs test overlaps there, "
                   "and Speculative the speeds of gaps. "
                   "Error: how far its centre has passed through the wall, or its depth in the wall at the end, m; 1 where its ends should "
                   "have hit the wall and did not. "
                   "Stable to 1e-6, bounded to 1."
                 : "A ball of 5 cm radius flies at a wall of 1 cm, restitution 1, no weight; 20 steps of 1/60 s. "
                   "Error: how far its surface is through the wall's front at the end, m, or the speed that it has lost, relative. "
                   "Stable to 1e-6, bounded to 0.5.",
           "resolution, response",
           spins ? "spin, rad/s" : "speed, m/s",
           names,
           brief(kSpeeds),
           {},
           {}};
    c.run = [all, spins](std::size_t r, std::size_t v)
    {
        const double speed = kSpeeds[v];
        const ContactAlgorithm& algorithm = all[r].contact;
        const std::string flyer =
            spins ? box("flyer", {0.5, 0.01, 0.01}, 1, {-0.3, 0, 0},
                        attribute("angular_velocity", Vec3{0, 0, speed}) +
                            attribute("orientation", "0.70710678118654757 0 0 0.70710678118654757"))
                  : ball("flyer", 0.05, 1, {-5.37 * speed / 60 - 0.055, 0, 0}, attribute("linear_velocity", Vec3{speed, 0, 0}));
        Trial t(
            component("wall.shape", "Shape/Box", attribute("half_extents", Vec3{0.005, 5, 5})) +
                component("wall", "State/Static", attribute("shape", std::string("wall.shape"))) + flyer +
                contact(algorithm, attribute("response.restitution", 1) + (algorithm.spring() ? attribute("response.stiffness", 1e8) : "")),
            dt(1.0 / 60));
        double worst = -1;
        t.run(spins ? 0.1 : 20.0 / 60, [&] { worst = std::fmax(worst, t.vec("flyer", "position").x); });
        if (!t.loaded()) return t.judge(0, {});
        const double front = -0.005 - (spins ? 0.01 : 0.05);
        const double through = std::fmax(0.0, worst - front);
        const bool should_hit = 0.1 * speed > 0.7, hit = length(t.vec("flyer", "linear_velocity")) > 0;
        if (spins) return t.judge(should_hit && !hit ? 1 : std::fmax(through, t.simulation().stepper().report().deepest), {1e-6, 1});
        const double lost = std::fabs(t.vec("flyer", "linear_velocity").x + speed) / speed;
        return t.judge(std::fmax(std::fmax(0.0, t.vec("flyer", "position").x - front), lost), {1e-6, 0.5});
    };
    c.quick = [](std::size_t, std::size_t v) { return v == 3; };
    return c;
}

}  // namespace

std::vector<Case> speed_cases() { return {wall(false), wall(true)}; }

}  // namespace plab::stability
