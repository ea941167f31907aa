// The streams of plabctl topics: rate, bandwidth, print.
#include <chrono>
#include <ctime>
#include <map>
#include <nlohmann/json.hpp>

#include "control/console/json.h"
#include "control/topics/spread.h"
#include "control/topics/topics.h"

namespace plab::cli
{
namespace
{

using Clock = std::chrono::steady_clock;
using link::RawSample;
using link::Seconds;

constexpr std::size_t kListMost = 16;  ///< elements of a list that print shows

double seconds_since(Clock::time_point begin) { return Seconds(Clock::now() - begin).count(); }

/// For pLab's topics the server's name selects the partition; other topics ignore it.
std::string partition_of(const Context& context, const TopicsArguments& arguments)
{
    if (!arguments.partition.empty()) return arguments.partition;
    for (const wire::Topic& topic : wire::topics())
        if (arguments.topic == topic.name) return context.settings.link.server;
    return {};
}

struct Opened
{
    Exit exit = Exit::Done;
    link::RawReader reader;
};
Opened open(Context& context, const TopicsArguments& arguments, bool wants_history)
{
    auto discovery = link::Discovery::make(context.session().participant());
    if (!discovery) return {context.fail(Exit::Failed, discovery.errors()), {}};
    const link::RawOptions options{partition_of(context, arguments), wants_history};
    const bool is_there = discovery->wait_for_writer(arguments.topic, options, context.timeout(), context.stop());
    auto reader = discovery->open(arguments.topic, options);
    if (!reader) return {context.fail(is_there ? Exit::Failed : Exit::NoServer, reader.errors()), {}};
    return {Exit::Done, reader.take()};
}

/// What came in one interval.
struct Interval
{
    Spread periods;  ///< s between samples of one writer
    Spread sizes;    ///< bytes
    double length = 0;

    double per_second() const { return length > 0 ? static_cast<double>(sizes.count()) / length : 0; }
    double bytes() const { return sizes.mean() * static_cast<double>(sizes.count()); }
};

/// Collects samples in intervals of one second, with separate periods for each writer.
class Meter
{
public:
    void add(const RawSample& sample, std::int64_t arrived_ns)
    {
        // The writer's time stamps are independent of when this process wakes up. Some writers send none.
        const std::int64_t at = sample.written_ns > 0 ? sample.written_ns : arrived_ns;
        const auto [last, is_first] = last_.try_emplace(sample.writer, at);
        if (!is_first) now_.periods.add(static_cast<double>(at - last->second) * 1e-9);
        last->second = at;
        now_.sizes.add(static_cast<double>(sample.bytes.size()));
    }
    Interval take(double length)
    {
        now_.length = length;
        return std::exchange(now_, {});
    }

private:
    Interval now_;
    std::map<std::uint64_t, std::int64_t> last_;
};

using Report = std::function<std::string(const Interval&)>;

/// One report per second, and one for the remainder at the end.
Exit measure(Context& context, const TopicsArguments& arguments, const Report& report)
{
    Opened opened = open(context, arguments, false);
    if (opened.exit != Exit::Done) return opened.exit;
    const std::optional<double>& duration = context.settings.duration;
    const std::uint64_t most = context.settings.count.value_or(~std::uint64_t{0});
    Meter meter;
    std::uint64_t reports = 0, samples = 0;
    const auto begin = Clock::now();
    auto since = begin;
    bool is_over = false;
    while (!is_over && reports < most)
    {
        const double left = std::min(1 - seconds_since(since), duration ? *duration - seconds_since(begin) : 1.0);
        (void)opened.reader.wait(Seconds(std::clamp(left, 0.0, 0.1)));
        opened.reader.take([&](const RawSample& sample) { meter.add(sample, dds_time()), ++samples; });
        is_over = context.stopped() || (duration && seconds_since(begin) >= *duration);
        if (!is_over && seconds_since(since) < 1) continue;
        const Interval interval = meter.take(seconds_since(since));
        // A remainder of a few milliseconds gives no meaningful rate.
        if (is_over && reports > 0 && interval.length < 0.5) break;
        since = Clock::now();
        ++reports;
        context.console.out(report(interval) + "\n");
        if (!context.console.flush()) return Exit::Done;
    }
    if (context.stopped()) return Exit::Interrupted;
    if (samples > 0) return Exit::Done;
    return context.fail(Exit::NoServer, "no sample of '" + arguments.topic + "' came");
}

/// Null if nothing was counted.
Json spread_json(const Spread& s)
{
    if (s.count() == 0) return {};
    return {{"mean", s.mean()}, {"min", s.least()}, {"max", s.most()}, {"stddev", s.deviation()}};
}

/// `what` per second, and the spread of `each`.
std::string interval_json(const Interval& i, const std::string& topic, const char* what, double per_second, const char* each,
                          const Spread& spread)
{
    return line_of(
        {{"topic", topic}, {"samples", i.sizes.count()}, {"seconds", i.length}, {what, per_second}, {each, spread_json(spread)}});
}

std::string rate_line(const Interval& i, const std::string& topic, bool is_json)
{
    if (is_json) return interval_json(i, topic, "rate", i.per_second(), "period", i.periods);
    std::string line = number(i.per_second()) + " /s   " + std::to_string(i.sizes.count()) + " samples";
    if (i.periods.count() == 0) return line;
    const auto ms = [](double s) { return duration_text(s * 1e9); };
    return line + "   period " + ms(i.periods.mean()) + ", min " + ms(i.periods.least()) + ", max " + ms(i.periods.most()) + ", stddev " +
           ms(i.periods.deviation());
}

std::string bandwidth_line(const Interval& i, const std::string& topic, bool is_json)
{
    const double per_second = i.length > 0 ? i.bytes() / i.length : 0;
    if (is_json) return interval_json(i, topic, "bytes_per_second", per_second, "size", i.sizes);
    std::string line = bytes_text(per_second) + "/s   " + std::to_string(i.sizes.count()) + " samples";
    if (i.sizes.count() == 0) return line;
    return line + "   size " + bytes_text(i.sizes.mean()) + ", min " + bytes_text(i.sizes.least()) + ", max " + bytes_text(i.sizes.most());
}

std::string time_text(std::int64_t ns)
{
    const std::time_t s = ns / 1'000'000'000;
    std::tm parts{};
    if (ns <= 0 || gmtime_r(&s, &parts) == nullptr) return "no time";
    char text[48];
    const std::size_t n = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &parts);
    std::snprintf(text + n, sizeof text - n, ".%06dZ", static_cast<int>(ns % 1'000'000'000 / 1000));
    return text;
}

/// A sample as text, or why it cannot be shown.
class SamplePrinter
{
public:
    SamplePrinter(const Context& context, const TopicsArguments& arguments, const link::RawReader& reader)
        : console_(context.console),
          topic_(arguments.topic),
          type_(reader.type()),
          key_(link::key_of(*type_)),
          most_(arguments.full ? ~std::size_t{0} : kListMost),
          is_json_(context.settings.json)
    {
    }

    Result<std::string> text(const RawSample& sample) const
    {
        const link::DynamicTypePtr& type = sample.has_value ? type_ : key_;
        if (is_json_) return json(sample, type.get());
        std::string out = console_.styled(Style::Dim, "--- " + time_text(sample.written_ns) + (sample.is_gone ? ", gone" : "")) + "\n";
        if (type == nullptr) return out;
        auto tree = link::tree_of(*type, sample.bytes, most_);
        if (!tree) return tree;
        return out + *tree;
    }

private:
    Result<std::string> json(const RawSample& sample, const link::DynamicType* type) const
    {
        Json json{{"topic", topic_}, {"written_ns", sample.written_ns}, {"gone", sample.is_gone}};
        if (type != nullptr)
        {
            auto value = json_of(*type, sample.bytes);
            if (!value) return value.errors();
            json[sample.has_value ? "sample" : "key"] = value.take();
        }
        return line_of(json) + "\n";
    }

    const Console& console_;
    std::string topic_;
    link::DynamicTypePtr type_, key_;
    std::size_t most_;
    bool is_json_;
};

}  // namespace

Exit print_rate(Context& context, const TopicsArguments& arguments)
{
    return measure(context, arguments, [&](const Interval& i) { return rate_line(i, arguments.topic, context.settings.json); });
}

Exit print_bandwidth(Context& context, const TopicsArguments& arguments)
{
    return measure(context, arguments, [&](const Interval& i) { return bandwidth_line(i, arguments.topic, context.settings.json); });
}

Exit print_samples(Context& context, const TopicsArguments& arguments)
{
    Opened opened = open(context, arguments, true);
    if (opened.exit != Exit::Done) return opened.exit;
    if (opened.reader.type() == nullptr)
        return context.fail(Exit::Failed, "samples of " + opened.reader.type_name() + " cannot be shown: " + opened.reader.why_opaque() +
                                              "; rate and bandwidth still work");
    const SamplePrinter printer(context, arguments, opened.reader);
    const std::optional<double>& duration = context.settings.duration;
    const std::uint64_t most = context.settings.count.value_or(~std::uint64_t{0});
    const auto begin = Clock::now();
    std::uint64_t shown = 0, broken = 0;
    const auto show = [&](const RawSample& sample)
    {
        if (shown + broken >= most) return;
        const auto text = printer.text(sample);
        ++(text ? shown : broken);
        if (text)
            context.console.out(*text);
        else
            (void)context.fail(Exit::Failed, "a sample of " + std::to_string(sample.bytes.size()) + " bytes: " + text.error().text());
    };
    while (shown + broken < most && !context.stopped() && (!duration || seconds_since(begin) < *duration))
    {
        (void)opened.reader.wait(Seconds(std::clamp(duration ? *duration - seconds_since(begin) : 0.1, 0.0, 0.1)));
        opened.reader.take(show);
        if (!context.console.flush()) return Exit::Done;
    }
    if (broken > 0) return Exit::Failed;
    if (context.stopped()) return Exit::Interrupted;
    if (shown > 0) return Exit::Done;
    return context.fail(Exit::NoServer, "no sample of '" + arguments.topic + "' came");
}

}  // namespace plab::cli
