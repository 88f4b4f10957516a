// SPDX-License-Identifier: GPL-3.0-or-later
//
// When a thread ends, MinGW's libstdc++ destroys its thread_local objects only after their memory
// is gone: both hang on keys of the thread, whose destructors run in the order in which the keys
// were made, and the key of the memory is made first. Here the key of the objects is made first.
#include <pthread.h>

#include <new>

namespace {

struct Destructor {
  void (*destroy)(void*);
  void* object;
  Destructor* before;
};

void destroy_all(void* last) {
  for (auto* one = static_cast<Destructor*>(last); one != nullptr;) {
    one->destroy(one->object);
    Destructor* const before = one->before;
    delete one;
    one = before;
  }
}

pthread_key_t key;

// Before all that could ask for memory of a thread.
[[gnu::constructor(101)]] void make_key() { pthread_key_create(&key, destroy_all); }

}  // namespace

// In place of libstdc++'s own.
extern "C" int __cxa_thread_atexit(void (*destroy)(void*), void* object, void*) noexcept {
  auto* const one = new (std::nothrow)
      Destructor{destroy, object, static_cast<Destructor*>(pthread_getspecific(key))};
  return one != nullptr && pthread_setspecific(key, one) == 0 ? 0 : -1;
}
