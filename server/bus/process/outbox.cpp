#include "bus/process/outbox.h"

#include <algorithm>

#include "idl/topics.h"

namespace plab::bus
{

void Outbox::send(const wire::Reply& answer, Clock::time_point now)
{
    const dds_return_t code = write_(answer);
    if (code == DDS_RETCODE_OK) return;
    if (failed_.size() < kMost)
        failed_.push_back({answer, now});
    else
        (void)trouble_->check(wire::topic_of<plab_v2_Reply>().name, code);
}

void Outbox::retry(Clock::time_point now)
{
    std::erase_if(failed_,
                  [&](const Failed& f)
                  {
                      const dds_return_t code = write_(f.answer);
                      if (code == DDS_RETCODE_OK) return true;
                      if (now - f.since < kPatience) return false;
                      return !trouble_->check(wire::topic_of<plab_v2_Reply>().name, code);
                  });
}

}  // namespace plab::bus
