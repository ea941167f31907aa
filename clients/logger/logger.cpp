#include "logger/logger.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "idl/samples.h"

namespace plab::logger
{
namespace
{

template <class T>
Result<void> subscribe(const link::Session& session, const wire::Entity& waitset, wire::DataReader<T>& out)
{
    auto reader = session.reader<T>();
    if (!reader) return reader.errors();
    out = reader.take();
    (void)dds_set_status_mask(out.entity().get(), DDS_DATA_AVAILABLE_STATUS);
    if (const auto code = dds_waitset_attach(waitset.get(), out.entity().get(), 0); code < 0)
        return wire::failed(std::string("cannot wait for ") + wire::topic_of<T>().name, code);
    return {};
}

}  // namespace

Result<Logger> Logger::make(const link::Session& session, const LoggerOptions& options, Output output)
{
    Logger out(std::move(output));
    out.options_ = options;
    out.lines_ = options.json ? make_json_lines() : make_human_lines();
    out.waitset_ = wire::Entity(dds_create_waitset(session.participant().get()));
    if (auto done = subscribe(session, out.waitset_, out.events_); !done) return done.errors();
    if (auto done = subscribe(session, out.waitset_, out.collisions_); !done) return done.errors();
    if (options.metrics)
        if (auto done = subscribe(session, out.waitset_, out.metrics_); !done) return done.errors();
    // Last: when the server's state arrives, the other readers exist already. Its line is the first.
    if (auto done = subscribe(session, out.waitset_, out.server_); !done) return done.errors();
    (void)session.wait(out.server_, link::Seconds(2));
    out.take_server();
    return out;
}

Output::State Logger::step(link::Seconds longest)
{
    const auto now = Order::Clock::now();
    const auto latest = now + std::chrono::duration_cast<Order::Clock::duration>(longest);
    const link::Seconds wait = order_.due(latest) - now;
    (void)dds_waitset_wait(waitset_.get(), nullptr, 0, link::duration_of(std::max(wait, link::Seconds(0))));
    take_all();
    write(order_.take(Order::Clock::now()));
    return output_.flush();
}

Output::State Logger::finish()
{
    take_all();
    write(order_.take_all());
    return output_.flush();
}

void Logger::take_all()
{
    take_server();
    take_events();
    take_collisions();
    if (options_.metrics) take_metrics();
}

void Logger::say_server(ServerChange change, const link::ServerInfo& info)
{
    // Entries of the former server come before.
    if (change != ServerChange::Found)
    {
        take_events();
        take_collisions();
        write(order_.take_all());
    }
    if (change != ServerChange::Gone) run_ = info.run;
    // The numbers of the next server start independently.
    if (change == ServerChange::Gone) event_numbers_.forget(), collision_numbers_.forget();
    output_.write(lines_->server(change, info));
}

void Logger::take_server()
{
    (void)server_.take(
        [&](const plab_v2_Server& sample, const dds_sample_info_t& info)
        {
            if (!info.valid_data || info.instance_state != DDS_IST_ALIVE)
            {
                if (is_there_) say_server(ServerChange::Gone, last_);
                is_there_ = false;
                return;
            }
            const link::ServerInfo now = wire::value_of<link::ServerInfo>(sample);
            const bool is_another = was_there_ && now.started_ns != last_.started_ns;
            // A server that was killed counts as gone only when its lease is over; its successor may appear before that.
            if (is_there_ && is_another) say_server(ServerChange::Gone, last_);
            if (!is_there_ || is_another) say_server(was_there_ ? ServerChange::Back : ServerChange::Found, now);
            is_there_ = was_there_ = true;
            last_ = now;
            if (options_.status) add(sample.run, sample.step, lines_->status(sample));
        });
}

template <class Sample>
void Logger::note_gap(const Sample& sample, const dds_sample_info_t& info, link::Sequence& numbers, const char* topic)
{
    const auto missing = numbers.note(info.publication_handle, sample.sequence_number, sample.entries._length);
    if (missing.count == 0) return;
    add(sample.run, sample.step, lines_->gap({topic, missing.first, missing.count}), false);
}

void Logger::take_events()
{
    (void)events_.take(
        [&](const plab_v2_Events& sample, const dds_sample_info_t& info)
        {
            if (!info.valid_data) return;
            note_gap(sample, info, event_numbers_, wire::topic_of<plab_v2_Events>().name);
            for (std::uint32_t i = 0; i < sample.entries._length; ++i)
                if (options_.filter.wants(sample.entries._buffer[i])) add(sample.run, sample.step, lines_->event(sample, i));
        });
}

void Logger::take_collisions()
{
    (void)collisions_.take(
        [&](const plab_v2_Collisions& sample, const dds_sample_info_t& info)
        {
            if (!info.valid_data) return;
            note_gap(sample, info, collision_numbers_, wire::topic_of<plab_v2_Collisions>().name);
            for (std::uint32_t i = 0; i < sample.entries._length; ++i)
                if (options_.filter.wants(sample.entries._buffer[i])) add(sample.run, sample.step, lines_->collision(sample, i));
        });
}

void Logger::take_metrics()
{
    (void)metrics_.take(
        [&](const plab_v2_Metrics& sample, const dds_sample_info_t& info)
        {
            if (info.valid_data) add(sample.run, sample.step, lines_->metrics(sample));
        });
}

void Logger::add(std::uint64_t run, std::int64_t step, std::string text, bool counts)
{
    order_.add({run, step, counts, std::move(text)}, Order::Clock::now());
}

void Logger::write(const std::vector<Line>& lines)
{
    for (const Line& line : lines)
    {
        if (is_full()) return;
        if (run_ != 0 && line.run > run_) output_.write(lines_->run(line.run));
        run_ = std::max(run_, line.run);
        output_.write(line.text);
        if (line.counts) ++written_;
    }
}

End follow(const LoggerOptions& options, const link::Stop& interrupted)
{
    using Clock = std::chrono::steady_clock;
    constexpr link::Seconds kCheckInterval(0.1);  // how late an interruption may be seen
    const auto begin = Clock::now();
    const auto is_over = [&] { return options.duration && link::Seconds(Clock::now() - begin).count() >= *options.duration; };
    const auto stop = [&] { return interrupted() || is_over(); };

    auto output = Output::open(options.out);
    if (!output) return {1, output.errors()};
    auto session = link::Session::join(options.link);
    if (!session) return {1, session.errors()};
    const link::Seconds patience = options.timeout > 0 ? link::Seconds(options.timeout) : link::kLongestWait;
    if (auto found = session->find_server(options.link, patience, stop); !found) return interrupted() ? End{} : End{3, found.errors()};
    auto logger = Logger::make(*session, options, output.take());
    if (!logger) return {1, logger.errors()};
    while (!stop() && !logger->is_full())
    {
        const auto state = logger->step(kCheckInterval);
        if (state == Output::State::Closed) return {};
        if (state == Output::State::Broken) return {1, {reason(logger->output().why())}};
    }
    if (!logger->is_full() && logger->finish() == Output::State::Broken) return {1, {reason(logger->output().why())}};
    return {};
}

Result<Output> Output::open(const std::string& file)
{
    Output out;
    out.name_ = file.empty() ? "standard output" : "'" + file + "'";
    if (file.empty()) return out;
    out.file_.reset(std::fopen(file.c_str(), "ae"));
    if (out.file_ == nullptr) return reason("cannot write " + out.name_ + ": " + std::strerror(errno));
    return out;
}

void Output::note_error()
{
    if (state_ != State::Good) return;
    state_ = errno == EPIPE ? State::Closed : State::Broken;
    why_ = "cannot write " + name_ + ": " + std::strerror(errno);
}

void Output::write(const std::string& line)
{
    std::FILE* const to = file_ ? file_.get() : stdout;
    if (std::fwrite(line.data(), 1, line.size(), to) != line.size() || std::fputc('\n', to) == EOF) note_error();
}

Output::State Output::flush()
{
    if (std::fflush(file_ ? file_.get() : stdout) != 0) note_error();
    return state_;
}

}  // namespace plab::logger
