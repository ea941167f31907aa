/// A sandboxed Lua state: the code of one script, without any state that would have to be saved.
///
/// The host rewinds, saves and restores columns, and knows nothing of Lua. If a call could leave a value behind inside Lua, a rewound step
/// would not give the same bits again. So the sandbox makes that impossible: after loading, globals are behind a proxy that refuses
/// assignments, tables are frozen and shared locals watched (freeze.h), and all else that a script can hold is immutable. A machine is then
/// a function of its code and its parameters, and can be built again from the columns at any time.
///
/// A call must also end, in bounded time and memory. A hook counts the instructions of Lua's virtual machine against a budget, built-in
/// functions charge for loops of their own, and strings are short, so that no instruction takes long (meter.h); memory comes from a block
/// of fixed size (arena.h). Once a budget is exceeded, pcall cannot catch that: every further instruction fails until the call returns.
/// What a failed call did is undone, and its forces, which are kept in a list until it has succeeded, are dropped.
/// Source: R. Ierusalimschy, Lua 5.4 reference manual, sections 4.4 (errors), 4.6 (lua_newstate) and 4.7 (hooks).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "lua/call.h"
#include "lua/meter.h"
#include "plab/result.h"

namespace plab::scripts
{

/// manual.cpp: everything that a script can use, with units and limits, in Markdown.
std::string manual();

struct Session;

/// Why a call ended with an error.
struct Failure
{
    std::string kind;     ///< of the event: "script.error", "script.over_budget", "script.out_of_memory"
    std::string message;  ///< "code:3: ..."
    Tick tick = 0;
    double time = 0;        ///< s
    bool reported = false;  ///< its event has been emitted
    bool booked = false;    ///< the component has been marked as quarantined
};

/// Used by one thread at a time; two machines share nothing. After a failure it refuses all calls until it is loaded again.
class Machine
{
public:
    explicit Machine(const Limits& limits);
    ~Machine();
    Machine(const Machine&) = delete;
    Machine& operator=(const Machine&) = delete;

    /// Discards everything, runs `code` once and freezes what it created. The error reads "line 3: ...".
    Result<void> load(const std::string& code, const Call& call);
    bool has_drive() const;
    bool has_force() const;

    /// Calls drive(step). Returns false on an error, see failure(); state, random numbers and queued changes are then as before.
    bool drive(const Call& call);
    /// Calls force(t, state). Returns false on an error, see failure(); there are no actions then.
    bool force(const Call& call);
    std::span<const Action> actions() const;

    const std::optional<Failure>& failure() const { return failure_; }
    void fail(const Call& call, std::string kind, std::string message);
    void mark_reported() { failure_->reported = true; }
    void mark_booked() { failure_->booked = true; }

    /// The largest number of instructions in one call since this was last called.
    std::int64_t take_instructions();
    std::size_t memory_used() const;

private:
    bool run(int function, int arguments, const Call& call);
    bool bind(const Call& call);
    void undo(const Call& call, std::size_t changes, std::int64_t random_state);

    std::unique_ptr<Session> session_;
    Entries state_before_;
    std::optional<Failure> failure_;
    std::int64_t most_instructions_ = 0;
};

}  // namespace plab::scripts
