/// plabctl topics: what is on the bus, whoever put it there, without knowing its types beforehand.
#pragma once

#include "control/context.h"
#include "link/discovery.h"

namespace plab::cli
{

void add_topics_command(const Command& app, Context& context);

struct TopicsArguments
{
    std::string what = "list", topic, partition;
    bool full = false;  ///< print: long lists are not cut short
};

Exit list_topics(Context& context, const TopicsArguments& arguments);

// Streams: until Ctrl-C, -d seconds or -n; NoServer if nobody writes the topic or nothing came.
Exit print_rate(Context& context, const TopicsArguments& arguments);       ///< -n counts reports, one a second
Exit print_bandwidth(Context& context, const TopicsArguments& arguments);  ///< same
Exit print_samples(Context& context, const TopicsArguments& arguments);    ///< -n counts samples

}  // namespace plab::cli
