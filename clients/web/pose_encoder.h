/// Frames as compact messages for the page. README.md has the layout.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <vector>

#include "idl/plab.h"
#include "web/outbox.h"

namespace plab::web
{

class PoseEncoder
{
public:
    /// `exact`: handles of bodies whose state also goes as 13 numbers of double precision, for plots.
    Poses encode(const plab_v2_Frame& frame, const std::set<std::uint32_t>& exact);
    /// The next frame is a key frame.
    void forget() { key_ = nullptr; }

private:
    /// A pose as it is sent: position to 24 bits, rotation to 1/32767.
    struct Row
    {
        std::array<float, 3> position{};
        std::array<std::int16_t, 4> rotation{};
        bool operator==(const Row&) const = default;
    };
    struct Part
    {
        std::vector<std::uint32_t> names;  ///< handles in a key frame, places in it in a delta
        std::vector<Row> rows;
        std::vector<std::uint32_t> shaft_names;
        std::vector<double> shafts;  ///< angle, speed
    };
    bool fits_key(const plab_v2_Frame& frame) const;
    void read(const plab_v2_Frame& frame);
    void find_changes();
    MessagePtr message_of(std::uint8_t kind, const Part& part, const plab_v2_Frame& frame, const std::set<std::uint32_t>& exact) const;

    Part now_, key_rows_, delta_;
    MessagePtr key_;
    std::uint64_t key_number_ = 0, number_ = 0;
    std::uint64_t run_ = 0, revision_ = 0;
    std::int64_t key_stamp_ = 0;  ///< ns
};

}  // namespace plab::web
