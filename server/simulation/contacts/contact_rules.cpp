#include "simulation/contacts/contact_rules.h"

namespace plab::simulation
{
namespace
{

std::string type_name(const world::World& world, std::uint32_t component)
{
    return component == kNoIndex ? "nothing" : world.type_of(component)->info.name;
}

Error refused(const world::World& world, const Detector& d, std::string why)
{
    Error e;
    e.element = world.id_of(d.component) + " (" + type_name(world, d.component) + ")";
    e.reason = std::move(why);
    return e;
}

}  // namespace

Errors check_contacts(const world::World& world, std::span<const Detector> detectors)
{
    Errors errors;
    for (const Detector& d : detectors)
    {
        if (d.resolution == kNoIndex) continue;
        const std::string resolution = type_name(world, d.resolution), response = type_name(world, d.response);
        if (d.speculates && !d.by_rows)
            errors.push_back(refused(world, d,
                                     resolution + " makes contacts of gaps that may close, which " + response +
                                         " cannot hold; it needs a response by rows, like Response/Rows"));
        if (world.type_of(d.resolution)->info.certifies && !d.gap)
            errors.push_back(refused(world, d,
                                     resolution + " looks for contacts inside a step by measuring gaps, which " +
                                         type_name(world, d.component) + " cannot; take Resolution/LocalBisection"));
    }
    return errors;
}

std::vector<std::string> unused_in_contacts(const world::World& world, std::span<const Detector> detectors)
{
    std::vector<std::string> out;
    for (const Detector& d : detectors)
    {
        if (d.resolution == kNoIndex || !d.by_force || !world.type_of(d.resolution)->info.locates) continue;
        out.push_back(world.id_of(d.component) + ": " + type_name(world, d.resolution) + " is not used, as contacts of " +
                      type_name(world, d.response) + " are forces: no time of impact is located");
    }
    return out;
}

}  // namespace plab::simulation
