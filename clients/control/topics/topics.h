/// plabctl topics: all topics on the bus, without knowing their types at compile time.
#pragma once

#include "control/command/context.h"
#include "link/discovery.h"

namespace plab::cli
{

void add_topics_command(const Command& app, Context& context);

struct TopicsArguments
{
    std::string what = "list", topic, partition;
    bool full = false;  ///< print: do not shorten long lists
};

Exit list_topics(Context& context, const TopicsArguments& arguments);

// Streams: until Ctrl-C, -d seconds or -n; NoServer if the topic has no writer or no sample arrived.
Exit print_rate(Context& context, const TopicsArguments& arguments);       ///< -n counts reports, one a second
Exit print_bandwidth(Context& context, const TopicsArguments& arguments);  ///< same
Exit print_samples(Context& context, const TopicsArguments& arguments);    ///< -n counts samples

}  // namespace plab::cli
