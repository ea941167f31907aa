#include "bench/peers/plab_engine.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "support/load.h"

namespace plab::peers
{
namespace
{

class PlabEngine final : public Engine
{
public:
    PlabEngine() : simulation_(test::library(), 1) {}

    Result<void> load(const std::string& text, std::size_t bodies)
    {
        const auto scene = test::compile_text(text);
        if (!scene) return scene.errors();
        if (auto loaded = simulation_.load(*scene); !loaded) return loaded;
        const world::World& world = simulation_.world();
        for (std::size_t i = 0; i < bodies; ++i) places_.push_back(world.component(world.find(body_id(i))).ref(kNoIndex));
        return {};
    }

    void advance(int steps) override
    {
        for (int i = 0; i < steps; ++i) simulation_.step();
    }
    void read(std::span<BodyState> out) const override
    {
        const world::HostTables& host = simulation_.world().host();
        for (std::size_t i = 0; i < places_.size(); ++i)
        {
            const std::uint32_t row = places_[i].index;
            if (places_[i].facet == Facet::Shaft)
            {
                out[i].turned = host.shafts.angle[row];
                out[i].angular_velocity = host.shafts.axis_W(row) * host.shafts.speed[row];
                continue;
            }
            out[i].position = host.bodies.position[row];
            out[i].orientation = host.bodies.orientation[row];
            out[i].velocity = host.bodies.velocity[row];
            out[i].angular_velocity = host.bodies.angular_velocity[row];
        }
    }

private:
    simulation::Simulation simulation_;
    std::vector<Ref> places_;
};

bool reads_like_type(std::string_view name)
{
    return name.size() > 2 && std::isupper(static_cast<unsigned char>(name[0])) != 0 && name.find('/') != std::string_view::npos &&
           name.find(' ') == std::string_view::npos;
}

}  // namespace

Result<std::unique_ptr<Engine>> make_plab_engine(const std::string& text, std::size_t bodies)
{
    auto engine = std::make_unique<PlabEngine>();
    if (auto loaded = engine->load(text, bodies); !loaded) return loaded.errors();
    return std::unique_ptr<Engine>(std::move(engine));
}

std::vector<std::string> missing_types(const std::string& text)
{
    const std::vector<std::string> known = test::library().names();
    std::vector<std::string> missing;
    for (std::size_t open = text.find('"'); open != std::string::npos;)
    {
        const std::size_t close = text.find('"', open + 1);
        if (close == std::string::npos) break;
        const std::string name = text.substr(open + 1, close - open - 1);
        const bool is_known = !reads_like_type(name) || std::binary_search(known.begin(), known.end(), name);
        if (!is_known && std::find(missing.begin(), missing.end(), name) == missing.end()) missing.push_back(name);
        open = text.find('"', close + 1);
    }
    return missing;
}

}  // namespace plab::peers
