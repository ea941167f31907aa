#include "replay/replay.h"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdio>
#include <string_view>

#include "replay/divergence.h"
#include "simulation/snapshot/format.h"

namespace plab::replay
{
namespace
{

/// The recorded hashes of one run, step by step.
class Hashes
{
public:
    explicit Hashes(record::RunLog& log) : log_(&log) {}
    Result<void> begin(std::uint64_t run)
    {
        record_ = {}, over_ = false;
        return log_->begin_hashes(run);
    }
    /// The hash of the state after `step` steps; empty if it was not recorded. Steps ascend.
    Result<std::optional<std::uint64_t>> at(Tick step)
    {
        while (!over_ && step >= end())
        {
            auto next = log_->next_hashes();
            if (!next) return next.errors();
            over_ = !*next;
            if (*next) record_ = *std::move(*next);
        }
        if (over_ || step < record_.step) return std::optional<std::uint64_t>();
        return std::optional(record_.values[static_cast<std::size_t>(step - record_.step)]);
    }
    /// Whether anything is recorded of steps after this one.
    Result<bool> more_after(Tick step)
    {
        auto at_next = at(step + 1);
        if (!at_next) return at_next.errors();
        return !over_;
    }

private:
    Tick end() const { return record_.step + static_cast<Tick>(record_.values.size()); }
    record::RunLog* log_;
    wire::Hashes record_;
    bool over_ = false;
};

/// Describes an entry of the journal.
struct JournalPlace
{
    std::uint64_t number = 0, run = 0;
    Tick step = 0;
    std::string text() const { return "step " + std::to_string(step) + " of run " + std::to_string(run); }
};

/// "" if no entry is missing between the two. The numbers count the requests of a server that took effect.
std::string gap_between(const JournalPlace& before, const JournalPlace& after)
{
    if (after.number <= before.number + 1) return {};
    const std::uint64_t first = before.number + 1, last = after.number - 1;
    return "the journal has a gap: " +
           (first == last ? "entry " + std::to_string(first) + " is"
                          : "entries " + std::to_string(first) + " to " + std::to_string(last) + " are") +
           " missing, " + (before.number == 0 ? "before " : "after " + before.text() + ", not after ") + after.text();
}

/// Whether the metadata state that the recording was made without this topic.
bool is_without(const record::RunLog& log, std::string_view topic)
{
    const std::string topics = " " + log.origin("topics") + " ";
    return topics.size() > 2 && topics.find(" " + std::string(topic) + " ") == std::string::npos;
}

class Replay
{
public:
    Replay(record::RunLog& log, simulation::Simulation& simulation, model::TypeSource& types, const ReplayOptions& options)
        : log_(&log), simulation_(&simulation), types_(&types), options_(&options), hashes_(log)
    {
    }

    Result<ReplayReport> go();

private:
    const record::RecordedSnapshot* beginning_of(std::uint64_t run) const;
    Result<void> begin(const record::RecordedSnapshot& snapshot);
    Result<void> run(std::uint64_t run);
    Result<void> read_journal(std::uint64_t run);
    void find_gaps(std::uint64_t run);
    Result<void> ask_what_is_due();
    Result<void> verify(std::uint64_t run);
    bool over()
    {
        if (!report_.mismatch && options_->stop && options_->stop()) report_.interrupted = true;
        return report_.interrupted || report_.mismatch;
    }

    record::RunLog* log_;
    simulation::Simulation* simulation_;
    model::TypeSource* types_;
    const ReplayOptions* options_;
    Hashes hashes_;
    std::vector<wire::Journal> journal_;
    std::size_t next_ = 0;
    /// The last journal entry of the previous runs; empty: the first number is not known.
    std::optional<JournalPlace> before_;
    std::uint64_t revisions_ahead_ = 0;  ///< by how much the revision of the recorded run exceeded this one's when it began
    ReplayReport report_;
};

const record::RecordedSnapshot* Replay::beginning_of(std::uint64_t run) const
{
    const record::RecordedSnapshot* best = nullptr;
    for (const record::RecordedSnapshot& s : log_->snapshots())
        if (s.run == run && (!best || (options_->from && s.step <= *options_->from))) best = &s;
    return best;
}

Result<void> Replay::begin(const record::RecordedSnapshot& snapshot)
{
    auto recorded = log_->read(snapshot);
    if (!recorded) return recorded.errors();
    auto decoded = simulation::decode(recorded->data, *types_);
    if (!decoded) return decoded.errors();
    if (auto restored = simulation_->restore(decoded->snapshot); !restored) return restored;
    revisions_ahead_ = recorded->revision - simulation_->revision();
    return {};
}

Result<void> Replay::read_journal(std::uint64_t run)
{
    auto journal = log_->journal(run);
    if (!journal) return journal.errors();
    journal_ = journal.take(), next_ = 0;
    find_gaps(run);
    // The run's first snapshot already includes a request that begins a run.
    std::erase_if(journal_, [](const wire::Journal& j) { return control::begins_a_run(j.operations); });
    return {};
}

void Replay::find_gaps(std::uint64_t run)
{
    for (const wire::Journal& entry : journal_)
    {
        const JournalPlace here{entry.sequence_number, run, entry.step};
        if (before_)
            if (std::string gap = gap_between(*before_, here); !gap.empty()) report_.doubts.push_back(std::move(gap));
        before_ = here;
    }
}

/// Carries out requests that took effect before the next step.
Result<void> Replay::ask_what_is_due()
{
    for (; next_ < journal_.size() && journal_[next_].step <= simulation_->tick(); ++next_)
    {
        const wire::Journal& entry = journal_[next_];
        if (entry.step < simulation_->tick()) continue;           // before the snapshot
        if (entry.origin == wire::kDecidedByComponent) continue;  // the component decides the same again
        wire::Request text;
        text.operations = entry.operations;
        auto wanted = control::wanted_of(text, *types_, simulation_->limits());
        if (!wanted) return wanted.errors();
        if (wanted->shutdown || !simulation::affects_the_run(wanted->request)) continue;
        // It took effect when it was recorded, whatever its trial would now give, since a trial may depend on the clock.
        wanted->request.trial.budget = simulation::TrialChoice::Budget::None;
        const simulation::Reply reply = simulation_->carry_out_now(wanted->request);
        ++report_.requests;
        if (!reply.done)
            return reason("the request of step " + std::to_string(entry.step) +
                          " cannot be replayed: " + (reply.errors.empty() ? std::string() : reply.errors.front().text()));
    }
    return {};
}

Result<void> Replay::verify(std::uint64_t run)
{
    auto recorded = hashes_.at(simulation_->tick());
    if (!recorded) return recorded.errors();
    if (!*recorded) return {};
    const std::uint64_t now = simulation_->state_hash();
    report_.last_hash = now;
    if (now == **recorded)
    {
        ++report_.verified;
        return {};
    }
    Mismatch mismatch;
    mismatch.run = run, mismatch.step = simulation_->tick(), mismatch.recorded = **recorded, mismatch.replayed = now;
    mismatch.replayed_revision = simulation_->revision() + revisions_ahead_;
    if (auto found = find_differences(*log_, *simulation_, *types_, mismatch, [&] { return ask_what_is_due(); }); !found) return found;
    report_.mismatch = std::move(mismatch);
    return {};
}

Result<void> Replay::run(std::uint64_t run)
{
    const record::RecordedSnapshot* const from = beginning_of(run);
    if (!from) return reason("the recording has no snapshot of run " + std::to_string(run) + ": there is no state to start from");
    if (auto begun = begin(*from); !begun) return begun;
    if (auto read = read_journal(run); !read) return read;
    if (auto begun = hashes_.begin(run); !begun) return begun;
    ++report_.runs;
    report_.made.push_back({run, simulation_->tick(), simulation_->tick(), simulation_->time()});
    if (options_->begun) options_->begun(simulation_->time());
    while (!report_.mismatch)
    {
        if (options_->until && simulation_->time() >= *options_->until - 0.5 * simulation_->dt()) break;
        auto more = hashes_.more_after(simulation_->tick());
        if (!more) return more.errors();
        if (!*more || over()) break;  // at its end, a run is no longer interrupted
        if (auto asked = ask_what_is_due(); !asked) return asked;
        if (!simulation_->step_once())
        {
            report_.interrupted = true;  // interrupted during the step: it does not count, whatever was verified before
            break;
        }
        ++report_.steps, report_.made.back().last = simulation_->tick();
        if (options_->verify)
            if (auto verified = verify(run); !verified) return verified;
        if (options_->stepped) options_->stepped();
    }
    return {};
}

Result<ReplayReport> Replay::go()
{
    std::vector<std::uint64_t> runs;
    for (const record::RecordedSnapshot& s : log_->snapshots())
        if (std::find(runs.begin(), runs.end(), s.run) == runs.end()) runs.push_back(s.run);
    if (options_->run) runs = {*options_->run};
    if (runs.empty())
        return reason(std::string("the recording has no snapshot to start from") +
                      (is_without(*log_, "plab/snapshots") ? ": it was made without plab/snapshots" : ""));
    if (is_without(*log_, "plab/journal"))
        report_.doubts.emplace_back("the recording was made without plab/journal: the requests of the run are not known");
    // plabd's own recordings cover a server's whole life, so the journal starts at its first entry.
    else if (!options_->run && log_->origin("recorder") == "plabd")
        before_ = JournalPlace{};
    for (const std::uint64_t r : runs)
    {
        if (over()) break;
        if (auto done = run(r); !done) return done.errors();
    }
    return report_;
}

}  // namespace

Result<ReplayReport> replay(record::RunLog& log, simulation::Simulation& simulation, model::TypeSource& types, const ReplayOptions& options)
{
    return Replay(log, simulation, types, options).go();
}

}  // namespace plab::replay
