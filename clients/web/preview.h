/// The preview of an exchange: plabctl's command `shadow`, in a process of its own, so that nothing here waits for it. One at a time.
#pragma once

#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>

#include "web/translate.h"

namespace plab::web
{

class Preview
{
public:
    using Then = std::function<void(const Result<Json>&)>;

    Preview() = default;
    Preview(const Preview&) = delete;
    Preview& operator=(const Preview&) = delete;
    /// Ends it.
    ~Preview();

    /// `then` gets what plabctl prints, or what it complains about; by update(), or at once if it cannot be started.
    void start(const link::SessionOptions& server, const PreviewAsk& ask, Then then);
    void update();

private:
    struct Closer
    {
        void operator()(std::FILE* file) const { (void)std::fclose(file); }
    };
    using File = std::unique_ptr<std::FILE, Closer>;

    int process_ = 0;  ///< 0: none runs
    File output_, complaints_;
    std::chrono::steady_clock::time_point end_;
    Then then_;
};

}  // namespace plab::web
