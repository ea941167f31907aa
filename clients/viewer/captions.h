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
    /// If there are more interactions than this, show those with the highest cost, and the number of the others.
    static constexpr std::size_t kMostLines = 12;
    static constexpr std::size_t kLongestLine = 72;  ///< characters

    /// The scene has changed. The selection of interactions stays the same until the next change.
    void use(const link::CatalogueContents& scene);

    /// From the top: title and time, then "id: algorithm" as it was in this state.
    std::vector<std::string> lines(const State& state) const;

private:
    /// An algorithm, and the step at which it became active.
    using Change = std::pair<std::int64_t, std::string>;

    const std::string& algorithm_at(const std::string& id, std::int64_t step) const;

    std::string title_;
    std::uint64_t run_ = 0;
    std::vector<std::string> shown_;  ///< ids
    std::size_t left_out_ = 0;
    std::map<std::string, bool> quarantined_;
    std::map<std::string, std::vector<Change>> algorithms_;
};

}  // namespace plab::view
