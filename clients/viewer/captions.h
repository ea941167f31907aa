/// The text in a picture: time, title and the algorithm of each interaction.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "link/catalogue.h"
#include "viewer/state.h"

namespace plab::view
{

class Captions
{
public:
    /// If there are more interactions than this, those with the same algorithm share a line with their number: in a scene with levels of
    /// detail that tells how many run at which level. Of more algorithms than this, the costliest are shown.
    static constexpr std::size_t kMostLines = 12;
    static constexpr std::size_t kLongestLine = 72;  ///< characters

    void use(const link::CatalogueContents& scene);

    /// From the top: title and time, then "id: algorithm", or "algorithm: number, such as id", as it was in this state.
    std::vector<std::string> lines(const State& state) const;

private:
    /// An algorithm, and the step at which it became active.
    using Change = std::pair<std::int64_t, std::string>;

    const std::string& algorithm_at(const std::string& id, std::int64_t step) const;
    std::vector<std::string> grouped_lines(std::int64_t step) const;

    std::string title_;
    std::uint64_t run_ = 0;
    struct Known
    {
        double cost = 0;  ///< ns, when the scene last changed
        bool is_quarantined = false;
    };
    std::map<std::string, Known> known_;  ///< the interactions of the scene
    std::map<std::string, std::vector<Change>> algorithms_;
};

}  // namespace plab::view
