#include "tools/pipeline/run_checkpoints.h"

#include "common/errors.h"

namespace flowskin::tools {

void RunCheckpoints::save(int frame, const std::function<void(StateWriter&)>& state) {
  header_.frame = frame;
  folder_.save(header_, state);
  saved_ = frame;
}

void RunCheckpoints::resume(Checkpoint& checkpoint, const std::function<void(StateReader&)>& state) {
  try {
    state(checkpoint.state());
    if (checkpoint.state().bytes_left() > 0) throw StateError("there is more in it than is expected");
  } catch (const InputError& error) {
    checkpoint.refuse(std::string("cannot be resumed from: ") + error.what());
  } catch (const std::exception& error) {
    checkpoint.refuse(std::string("does not fit this program: ") + error.what() + "; run the scene anew");
  }
  saved_ = checkpoint.header().frame;
}

}  // namespace flowskin::tools
