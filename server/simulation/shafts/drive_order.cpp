#include "simulation/shafts/drive_order.h"

#include <algorithm>

#include "plab/ref.h"

namespace plab::simulation
{
namespace
{

/// Repeatedly removes the drives whose driven shaft drives nothing (Kahn's algorithm). The drives that remain contain all cycles.
std::vector<std::uint8_t> on_circles(const std::vector<OneWayDrive>& drives, std::span<const std::uint32_t> root)
{
    std::vector<std::uint32_t> driven_on(root.size(), 0);  // by root: number of drives of which it is the driver
    std::vector<std::vector<std::uint32_t>> into(root.size());
    for (std::uint32_t d = 0; d < drives.size(); ++d)
    {
        ++driven_on[root[drives[d].driver]];
        into[root[drives[d].driven]].push_back(d);
    }
    std::vector<std::uint32_t> ends;
    for (std::uint32_t r = 0; r < root.size(); ++r)
        if (driven_on[r] == 0) ends.push_back(r);
    std::vector<std::uint8_t> left(drives.size(), 1);
    for (std::size_t i = 0; i < ends.size(); ++i)
        for (const std::uint32_t d : into[ends[i]])
        {
            left[d] = 0;
            const std::uint32_t driver = root[drives[d].driver];
            if (--driven_on[driver] == 0) ends.push_back(driver);
        }
    return left;
}

}  // namespace

Errors check_drives(std::vector<OneWayDrive> drives, std::span<const std::uint32_t> root, std::span<const std::uint8_t> prescribed,
                    const ShaftDirectory& directory)
{
    if (drives.empty()) return {};
    std::sort(drives.begin(), drives.end(),
              [&](const OneWayDrive& a, const OneWayDrive& b)
              { return directory.rank_of_component(a.component) < directory.rank_of_component(b.component); });
    Errors errors;
    for (const OneWayDrive& d : drives)
        if (prescribed[root[d.driven]] != 0)
            errors.push_back({{},
                              directory.component_id(d.component),
                              "drives " + directory.shaft_id(d.driven) + ", whose motion is prescribed; it must be dynamic"});

    const std::vector<std::uint8_t> left = on_circles(drives, root);
    std::vector<std::uint32_t> next(root.size(), kNoIndex);  // by root: the first remaining drive that starts there
    for (std::uint32_t d = 0; d < drives.size(); ++d)
        if (left[d] != 0 && next[root[drives[d].driver]] == kNoIndex) next[root[drives[d].driver]] = d;

    std::vector<std::uint32_t> walk_of(drives.size(), kNoIndex);
    for (std::uint32_t start = 0; start < drives.size(); ++start)
    {
        if (left[start] == 0 || walk_of[start] != kNoIndex) continue;
        std::uint32_t d = next[root[drives[start].driver]];
        while (walk_of[d] == kNoIndex) walk_of[d] = start, d = next[root[drives[d].driven]];
        if (walk_of[d] != start) continue;  // leads into a cycle that was already reported
        std::string circle;
        const std::uint32_t first = d;
        do {
            circle += directory.component_id(drives[d].component) + " -> ";
            d = next[root[drives[d].driven]];
        } while (d != first);
        const std::string id = directory.component_id(drives[first].component);
        errors.push_back({{}, id, "one-way drives form a cycle: " + circle + id + "; one of them must react to its driven shaft"});
    }
    return errors;
}

}  // namespace plab::simulation
