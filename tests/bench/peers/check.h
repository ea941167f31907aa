/// Known figures of the peers, which adapters and metrics have to reach.
#pragma once

#include <string>
#include <vector>

namespace plab::peers
{

struct Checked
{
    std::string run, metric;
    double known = 0, measured = 0;
    bool good = false;
};

/// Checks known figures that do not depend on the machine: closed forms of first-order methods, and results of the peers in
/// measurements made with other programs. Also checks that the reference of case a does not change when its step is halved.
std::vector<Checked> check_adapters();

}  // namespace plab::peers
