/// The architecture as data: which folder may include which. The only place in the tests that states it.
#pragma once

#include <string_view>
#include <vector>

namespace plab::architecture
{

using Words = std::vector<std::string_view>;

struct Layer
{
    std::string_view folder;  ///< "x/*" stands for each folder in x: its files may include their own folder, not their sisters
    Words may_include;        ///< layers, beside its own folder and the C++ standard library
    Words third_party;        ///< headers, or folders of headers with their '/'
    bool headers_too = true;  ///< third party may stand in its headers as well
};

/// A file belongs to the first layer that holds it. Dependencies run downhill: whatever is not listed is forbidden.
inline const std::vector<Layer>& layers()
{
    static const std::vector<Layer> table{
        {"server/base", {}, {}},         // everybody may include it
        {"server/sdk", {}, {"Eigen/"}},  // plab/eigen.h alone, which no other header of it includes
        {"server/linear", {"server/sdk"}, {}},
        {"server/geometry", {}, {}},
        {"server/model", {"server/sdk"}, {}},
        {"server/world", {"server/sdk", "server/model"}, {}},
        {"server/blueprint", {"server/sdk", "server/model"}, {"expat.h"}, false},
        {"server/import/meshes", {"server/sdk"}, {"assimp/"}, false},
        {"server/import",
         {"server/sdk", "server/model", "server/blueprint", "server/plugins", "server/objects/shapes", "server/import/meshes"},
         {}},
        {"server/export", {"server/sdk", "server/model", "server/world", "server/import"}, {}},
        {"server/plugins/manifest_main", {"server/sdk", "server/model", "server/plugins", "server/program"}, {}},
        {"server/plugins", {"server/sdk", "server/model"}, {"dlfcn.h"}, false},
        {"server/completion", {"server/sdk", "server/model", "server/blueprint", "server/plugins", "server/program"}, {"unistd.h"}, false},
        // From below: what a step is made of, a run, snapshots of it and transactions on it, and the simulation that owns them.
        {"server/simulation/groups", {"server/sdk", "server/model", "server/world"}, {}},
        {"server/simulation/costs", {"server/sdk", "server/model", "server/world", "server/simulation/groups"}, {}},
        {"server/simulation/shafts", {"server/sdk", "server/model", "server/world", "server/simulation/groups"}, {}},
        {"server/simulation/rows",
         {"server/sdk", "server/linear", "server/model", "server/world", "server/simulation/costs", "server/simulation/groups",
          "server/simulation/shafts"},
         {}},
        {"server/simulation/articulated", {"server/sdk", "server/linear", "server/world"}, {}},
        {"server/simulation/threads", {"server/sdk"}, {}},
        {"server/simulation/systems",
         {"server/sdk", "server/model", "server/world", "server/simulation/costs", "server/simulation/groups", "server/simulation/shafts",
          "server/simulation/rows", "server/simulation/articulated"},
         {}},
        {"server/simulation/motion",
         {"server/sdk", "server/model", "server/world", "server/simulation/systems", "server/simulation/shafts",
          "server/simulation/threads"},
         {}},
        {"server/simulation/contacts",
         {"server/sdk", "server/model", "server/world", "server/simulation/systems", "server/simulation/motion"},
         {}},
        {"server/simulation/contact_forces",
         {"server/sdk", "server/model", "server/world", "server/simulation/motion", "server/simulation/contacts"},
         {}},
        {"server/simulation/advance",
         {"server/sdk", "server/model", "server/world", "server/simulation/motion", "server/simulation/contact_forces"},
         {}},
        {"server/simulation/events",
         {"server/sdk", "server/model", "server/world", "server/simulation/motion", "server/simulation/contacts",
          "server/simulation/advance"},
         {}},
        {"server/simulation/step",
         {"server/sdk", "server/model", "server/world", "server/simulation/costs", "server/simulation/shafts", "server/simulation/contacts",
          "server/simulation/events"},
         {}},
        {"server/simulation/levels",
         {"server/sdk", "server/model", "server/world", "server/simulation/costs", "server/simulation/requests", "server/simulation/step"},
         {}},
        {"server/simulation/watch",
         {"server/sdk", "server/geometry", "server/model", "server/world", "server/simulation/contacts", "server/simulation/step"},
         {}},
        {"server/simulation/requests", {"server/sdk", "server/model", "server/world", "server/simulation/costs"}, {}},
        {"server/simulation/run",
         {"server/sdk", "server/model", "server/world", "server/simulation/requests", "server/simulation/step", "server/simulation/watch",
          "server/simulation/levels"},
         {}},
        {"server/simulation/snapshot",
         {"server/sdk", "server/model", "server/world", "server/simulation/requests", "server/simulation/run"},
         {"gnu/libc-version.h"}},
        {"server/simulation/transaction",
         {"server/sdk", "server/model", "server/world", "server/simulation/costs", "server/simulation/requests", "server/simulation/step",
          "server/simulation/run"},
         {}},
        {"server/simulation",
         {"server/sdk", "server/model", "server/world", "server/simulation/costs", "server/simulation/step", "server/simulation/run",
          "server/simulation/snapshot", "server/simulation/transaction"},
         {}},
        {"server/publish", {"server/sdk", "server/model", "server/world", "server/simulation", "idl/values"}, {"emmintrin.h"}},
        {"server/control",
         {"server/sdk", "server/model", "server/world", "server/simulation", "server/blueprint", "idl/values"},
         {"nlohmann/"},
         false},
        {"server/bus/channel", {"server/publish", "idl/values"}, {"sys/", "unistd.h", "fcntl.h"}},
        {"server/ros", {"server/sdk", "server/import", "server/bus/channel", "server/bus/process", "clients/link", "clients/ros"}, {}},
        {"server/bus/process",
         {"server/sdk", "server/publish", "server/bus", "server/bus/channel", "server/program", "idl", "idl/values"},
         {"dds/", "sys/", "unistd.h", "fcntl.h", "poll.h", "pthread.h"}},
        {"server/bus",
         {"server/sdk", "server/publish", "server/bus/channel", "idl", "idl/values"},
         {"sys/", "unistd.h", "fcntl.h", "poll.h", "pthread.h", "spawn.h"}},
        {"server/record", {"server/sdk", "server/publish", "idl", "idl/values", "idl/recording"}, {}},
        {"server/replay",
         {"server/sdk", "server/model", "server/world", "server/simulation", "server/publish", "server/control", "server/record"},
         {}},
        {"server/daemon",
         {"server/sdk", "server/model", "server/world", "server/blueprint", "server/import", "server/export", "server/plugins",
          "server/simulation", "server/publish", "server/control", "server/bus", "server/record", "server/replay", "server/program",
          "server/completion", "idl/values", "idl/json"},
         {"spdlog/", "CLI/", "nlohmann/", "unistd.h", "poll.h", "pthread.h", "sys/eventfd.h"},
         false},
        {"server/study",
         {"server/sdk", "server/model", "server/world", "server/blueprint", "server/plugins", "server/simulation", "server/publish",
          "server/control", "server/record", "server/replay", "server/figures", "server/program", "server/completion", "scenes/exact",
          "idl/values", "idl/json"},
         {"CLI/", "nlohmann/", "time.h", "unistd.h", "sys/utsname.h"},
         false},
        {"scenes/exact", {"server/sdk", "server/model", "server/world", "server/simulation"}, {}},
        {"server/program", {}, {"CLI/", "fcntl.h", "signal.h", "sys/", "time.h", "unistd.h"}, false},
        {"server/picture", {}, {"cairo/", "png.h"}},
        {"server/figures", {"server/picture"}, {"cairo/"}, false},
        {"server/render", {"server/picture"}, {"GL/", "cairo/"}},
        {"server/objects/cameras", {"server/sdk", "server/render"}, {}},
        {"server/objects/solvers", {"server/sdk", "server/linear"}, {}},
        {"server/objects/*", {"server/sdk"}, {}},
        {"interactions/detection", {"server/sdk", "server/geometry"}, {"ode/", "Eigen/"}},
        {"interactions/constraints/joints", {"server/sdk", "interactions/constraints/angular_velocity"}, {}},
        {"interactions/constraints/angular_velocity", {"server/sdk"}, {}},
        {"interactions/constraints/grab", {"server/sdk"}, {}},
        {"interactions/managers", {"server/sdk", "server/linear"}, {}},
        {"interactions/scripts/lua", {"server/sdk"}, {"lua.hpp"}},
        {"interactions/rules", {"server/sdk", "interactions/scripts/lua"}, {}},
        {"interactions/*", {"server/sdk"}, {}},
        {"idl/values", {}, {}},  // plain values: files that include them see no DDS
        {"idl/json", {"idl/values"}, {"nlohmann/"}},
        {"idl/recording",
         {"idl"},
         {"dds/", "zlib.h", "zstd.h", "lz4frame.h", "fcntl.h", "unistd.h", "sys/stat.h", "pthread.h", "semaphore.h"}},
        {"idl", {"idl/values"}, {"dds/", "sys/", "unistd.h"}},
        {"clients/link", {"idl", "idl/values", "idl/json"}, {"dds/", "nlohmann/"}},
        {"clients/completion", {"server/program", "clients/link"}, {"unistd.h"}, false},
        {"clients/viewer",
         {"server/program", "server/picture", "server/render", "idl", "idl/recording", "clients/link", "clients/completion"},
         {"CLI/", "unistd.h", "sys/", "fcntl.h", "signal.h", "spawn.h"}},
        {"clients/control/console", {"clients/link"}, {"nlohmann/", "unistd.h", "sys/"}},
        {"clients/control/command", {"server/program", "clients/link", "clients/control/console"}, {"CLI/"}, false},
        {"clients/control/recording/recorder", {"idl", "idl/recording", "clients/link"}, {"dds/"}},
        {"clients/control/recording/player", {"idl", "idl/recording", "clients/link"}, {"dds/", "poll.h", "sys/", "termios.h", "unistd.h"}},
        {"clients/control/recording/analysis",
         {"server/program", "server/figures", "idl", "idl/json", "idl/recording", "clients/link", "clients/logger"},
         {"nlohmann/"}},
        {"clients/control/recording",
         {"server/program", "server/figures", "idl", "idl/recording", "clients/link", "clients/logger", "clients/control/console",
          "clients/control/command", "clients/control/recording/analysis", "clients/control/recording/recorder",
          "clients/control/recording/player"},
         {"nlohmann/"},
         false},
        {"clients/control/topics", {"clients/link", "clients/control/console", "clients/control/command"}, {"nlohmann/"}, false},
        {"clients/control/live",
         {"server/program", "idl", "clients/link", "clients/control/console", "clients/control/command"},
         {"nlohmann/", "unistd.h", "sys/", "signal.h", "spawn.h", "fcntl.h"},
         false},
        {"clients/control",
         {"server/program", "idl", "clients/link", "clients/completion", "clients/control/console", "clients/control/command",
          "clients/control/live", "clients/control/topics", "clients/control/recording", "clients/control/recording/analysis"},
         {}},
        {"clients/websocket", {}, {"libwebsockets.h", "fcntl.h", "unistd.h"}, false},
        {"clients/web",
         {"server/program", "idl", "idl/json", "idl/recording", "clients/link", "clients/completion", "clients/websocket"},
         {"CLI/", "nlohmann/", "fcntl.h", "signal.h", "spawn.h", "sys/", "unistd.h"},
         false},
        {"clients/foxglove",
         {"server/program", "idl", "idl/json", "idl/recording", "clients/link", "clients/completion", "clients/websocket",
          "clients/control/recording/player"},
         {"CLI/", "nlohmann/", "unistd.h"},
         false},
        {"clients/ros", {"idl", "idl/values", "clients/link"}, {"dds/", "regex.h"}},
        {"clients/python/native", {"idl", "idl/json", "idl/recording", "clients/link"}, {"nlohmann/"}, false},
        {"clients/*",
         {"server/program", "idl", "clients/link", "clients/completion"},
         {"CLI/", "nlohmann/", "unistd.h", "sys/", "signal.h"}},
        {"tests/bench/peers",
         {"server", "tests/support"},
         {"ode/", "btBulletDynamicsCommon.h", "BulletDynamics/", "Simbody.h", "nlohmann/", "unistd.h", "poll.h", "sys/"},
         false},
        {"tests/bus/foreign", {"server", "clients", "idl", "tests"}, {"doctest/", "fastdds/", "plabPubSubTypes.h"}, false},
        {"tests",
         {"server", "interactions", "clients", "idl", "scenes"},
         {"doctest/", "nlohmann/", "assimp/", "dds/", "Eigen/", "unsupported/Eigen/", "png.h", "unistd.h", "fcntl.h", "signal.h", "dlfcn.h",
          "sys/", "malloc.h", "poll.h", "termios.h", "arpa/", "netinet/"}},
    };
    return table;
}

/// Files that the build makes.
inline const Words& generated_files()
{
    static const Words files{"idl/plab.h",
                             "idl/recording/plab_idl_text.h",
                             "idl/ros/rmw_dds_common.h",
                             "idl/ros/ros_gz_interfaces.h",
                             "idl/ros/rosgraph_msgs.h",
                             "idl/ros/sensor_msgs.h",
                             "idl/ros/simulation_interfaces.h",
                             "idl/ros/tf2_msgs.h",
                             "idl/ros/visualization_msgs.h"};
    return files;
}

/// Folders that includes are relative to, beside the file's own folder and the root of its layer.
inline const Words& include_roots()
{
    static const Words roots{"server/base", "server/sdk", "server", "interactions", "clients", "tests", "scenes", ""};
    return roots;
}

/// C++20, without the C library's own names (<math.h>): those put functions into the global name space.
inline const Words& standard_headers()
{
    // clang-format off
    static const Words headers{
        "algorithm", "any", "array", "atomic", "barrier", "bit", "bitset", "cassert", "cctype", "cerrno", "cfenv",
        "cfloat", "charconv", "chrono", "cinttypes", "climits", "clocale", "cmath", "compare", "complex", "concepts",
        "condition_variable", "csetjmp", "csignal", "cstdarg", "cstddef", "cstdint", "cstdio", "cstdlib", "cstring",
        "ctime", "cwchar", "deque", "exception", "execution", "filesystem", "forward_list", "fstream", "functional",
        "future", "initializer_list", "iomanip", "ios", "iosfwd", "iostream", "istream", "iterator", "latch",
        "limits", "list", "locale", "map", "memory", "memory_resource", "mutex", "new", "numbers", "numeric",
        "optional", "ostream", "queue", "random", "ranges", "ratio", "regex", "scoped_allocator", "semaphore", "set",
        "shared_mutex", "source_location", "span", "sstream", "stack", "stdexcept", "stop_token", "streambuf",
        "string", "string_view", "system_error", "thread", "tuple", "type_traits", "typeindex", "typeinfo",
        "unordered_map", "unordered_set", "utility", "valarray", "variant", "vector", "version"};
    // clang-format on
    return headers;
}

inline constexpr int kLinesWanted = 400;   ///< more are listed
inline constexpr int kLinesAllowed = 450;  ///< more fail

}  // namespace plab::architecture
