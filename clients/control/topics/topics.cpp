#include "control/topics/topics.h"

#include <nlohmann/json.hpp>

#include "control/console/json.h"
#include "control/console/table.h"

namespace plab::cli
{
namespace
{

constexpr double kQuiet = 0.3;  ///< s without news: what is there has shown itself

constexpr const char* kTopicExamples =
    "  plabctl topics                                list all topics in the domain, pLab's or not\n"
    "  plabctl topics rate plab/states -d 5          samples per second and their periods, one line per second\n"
    "  plabctl topics bandwidth plab/states -n 3     bytes per second and sizes, three lines\n"
    "  plabctl topics print plab/events --json       samples as lines of JSON\n"
    "  plabctl topics print rt/chatter -n 1          a foreign type, fetched from its writer";

std::string joined(const std::set<std::string>& words, const char* for_empty)
{
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : "; ") + (word.empty() ? std::string(for_empty) : word);
    return out;
}

const char* word_for(link::Origin origin)
{
    switch (origin)
    {
        case link::Origin::Plab:
            return "yes";
        case link::Origin::OtherVersion:
            return "other version";
        case link::Origin::Foreign:
            return "no";
    }
    return "no";
}

std::string json_line(const std::vector<link::TopicInfo>& topics)
{
    Json list = Json::array();
    for (const link::TopicInfo& t : topics)
        list.push_back({{"topic", t.name},
                        {"type", t.type},
                        {"partitions", t.partitions},
                        {"writers", t.writers},
                        {"readers", t.readers},
                        {"qos", t.qos},
                        {"plab", t.origin == link::Origin::Plab},
                        {"other_version", t.origin == link::Origin::OtherVersion}});
    return line_of({{"topics", std::move(list)}}) + "\n";
}

Exit run_topics(Context& context, const TopicsArguments& arguments)
{
    const bool is_list = arguments.what == "list";
    if (is_list != arguments.topic.empty())
        return context.fail(Exit::Usage, is_list ? "list takes no topic; print TOPIC shows its samples"
                                                 : arguments.what + " needs a topic: plabctl topics " + arguments.what + " plab/states");
    if (const Exit e = context.join(); e != Exit::Done) return e;
    if (is_list) return list_topics(context, arguments);
    if (arguments.what == "rate") return print_rate(context, arguments);
    if (arguments.what == "bandwidth") return print_bandwidth(context, arguments);
    return print_samples(context, arguments);
}

}  // namespace

Exit list_topics(Context& context, const TopicsArguments& arguments)
{
    auto discovery = link::Discovery::make(context.session().participant());
    if (!discovery) return context.fail(Exit::Failed, discovery.errors());
    auto topics = discovery->topics(link::Seconds(kQuiet), context.timeout(), context.stop());
    const std::string& only = arguments.partition.empty() ? context.settings.link.server : arguments.partition;
    if (!only.empty()) std::erase_if(topics, [&](const link::TopicInfo& t) { return !t.partitions.contains(only); });
    if (context.settings.json)
        context.console.out(json_line(topics));
    else if (topics.empty())
        context.console.say("no topics in domain " + std::to_string(context.settings.link.domain.id) +
                            (only.empty() ? "" : ", partition '" + only + "'"));
    else
    {
        Table table({{"TOPIC", Align::Left, Shrink::Middle},
                     {"TYPE", Align::Left, Shrink::Middle, 1},
                     {"PLAB", Align::Left, Shrink::Never, 2},
                     {"PARTITION", Align::Left, Shrink::End},
                     {"WRITERS", Align::Right, Shrink::Never, 3},
                     {"READERS", Align::Right, Shrink::Never, 4},
                     {"QOS", Align::Left, Shrink::End}});
        for (const link::TopicInfo& t : topics)
            table.add({t.name, t.type, word_for(t.origin), joined(t.partitions, "(default)"), std::to_string(t.writers),
                       std::to_string(t.readers), joined(t.qos, "")},
                      t.writers == 0 ? Style::Dim : Style::Plain);
        table.print(context.console);
    }
    context.console.flush();
    return Exit::Done;
}

void add_topics_command(const Command& app, Context& context)
{
    const auto arguments = std::make_shared<TopicsArguments>();
    const Command command =
        add_command(app, context, {"topics", "inspect the topics on the bus, pLab's or not: list, rate, bandwidth, print", kTopicExamples},
                    [arguments](Context& c) { return run_topics(c, *arguments); });
    command.add_option("what", arguments->what, "list, rate, bandwidth or print")
        .one_of({"list", "rate", "bandwidth", "print"})
        .show_default();
    command.add_option("topic", arguments->topic, "name of the topic, as shown by list");
    command.add_option("--partition", arguments->partition, "only topics in this partition (a server's partition is its name)");
    command.add_flag("--full", arguments->full, "print: do not shorten long lists");
}

}  // namespace plab::cli
