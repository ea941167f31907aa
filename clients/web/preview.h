/// The preview of an exchange: plabctl's command `shadow`, in a process of its own, so that nothing here waits for it. One at a time.
#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "program/child.h"
#include "web/translate.h"

namespace plab::web
{

class Preview
{
public:
    using Then = std::function<void(const Result<Json>&)>;

    /// `then` gets what plabctl prints, or what it complains about; by update(), or at once if it cannot be started.
    void start(const link::SessionOptions& server, const PreviewAsk& ask, Then then);
    void update();

private:
    std::optional<program::Child> child_;  ///< nothing: none runs
    std::string printed_;
    std::chrono::steady_clock::time_point end_;
    Then then_;
};

}  // namespace plab::web
