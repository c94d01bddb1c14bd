#include "linear_algebra/blas_threads.h"

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD

#include <mutex>
#include <shared_mutex>

#ifdef _WIN32
#include <windows.h>
// Macros for 16-bit compilers, and ordinary words in the sources compiled together with this one.
#undef near
#undef far
#else
#include <dlfcn.h>
#endif

// BLAS, Fortran linkage. Its address identifies the library that serves CHOLMOD; on Windows without dllimport it would
// be the address of a stub in our own module. No other file may declare it without dllimport, since files are compiled
// together.
#ifdef _WIN32
extern "C" __declspec(dllimport) void zscal_(const int*, const void*, void*, const int*);
#else
extern "C" void zscal_(const int*, const void*, void*, const int*);
#endif

namespace spectral_conformal {
namespace {

/// The loaded library that defines zscal_. It stays loaded, since CHOLMOD is linked to it.
#ifdef _WIN32
class BlasFile {
 public:
  BlasFile() {
    const DWORD flags = GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
    if (GetModuleHandleExA(flags, reinterpret_cast<LPCSTR>(&zscal_), &handle_) == 0) handle_ = nullptr;
  }
  std::string name() const {
    char name[MAX_PATH];
    return handle_ == nullptr ? "" : std::string(name, GetModuleFileNameA(handle_, name, MAX_PATH));
  }
  void* find(const char* symbol) const {
    return handle_ == nullptr ? nullptr : reinterpret_cast<void*>(GetProcAddress(handle_, symbol));
  }

 private:
  HMODULE handle_ = nullptr;
};
#else
class BlasFile {
 public:
  BlasFile() {
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void*>(&zscal_), &info) == 0 || info.dli_fname == nullptr) return;
    name_ = info.dli_fname;
    handle_ = dlopen(info.dli_fname, RTLD_LAZY | RTLD_NOLOAD);
  }
  ~BlasFile() {
    if (handle_ != nullptr) dlclose(handle_);
  }
  BlasFile(const BlasFile&) = delete;
  BlasFile& operator=(const BlasFile&) = delete;
  std::string name() const { return name_; }
  void* find(const char* symbol) const { return handle_ == nullptr ? nullptr : dlsym(handle_, symbol); }

 private:
  void* handle_ = nullptr;
  std::string name_;
};
#endif

/// OpenBLAS-specific functions; null in any other BLAS.
struct OpenBlas {
  int (*get_parallel)() = nullptr;
  int (*get_num_threads)() = nullptr;
  void (*set_num_threads)(int) = nullptr;
  const char* (*get_config)() = nullptr;
  const char* (*get_corename)() = nullptr;

  explicit OpenBlas(const BlasFile& file) {
    find(file, "openblas_get_parallel", get_parallel);
    find(file, "openblas_get_num_threads", get_num_threads);
    find(file, "openblas_set_num_threads", set_num_threads);
    find(file, "openblas_get_config", get_config);
    find(file, "openblas_get_corename", get_corename);
  }
  bool has_threads() const { return get_num_threads != nullptr && set_num_threads != nullptr; }

 private:
  template <class Function>
  static void find(const BlasFile& file, const std::string& name, Function& function) {
    void* symbol = file.find(name.c_str());
    if (symbol == nullptr) symbol = file.find(("scipy_" + name).c_str());  // as in the wheels of scipy-openblas32
    function = reinterpret_cast<Function>(symbol);
  }
};

const OpenBlas& open_blas() {
  static const OpenBlas functions{BlasFile()};
  return functions;
}

/// The holders of the process-wide setting; one object per process, like the setting.
struct Holders {
  std::shared_mutex gate;  ///< shared if several may hold at once
  std::mutex counting;     ///< guards the following
  int count = 0;
  int before = 0;  ///< the setting found by the first holder
};

/// How many this thread holds; a nested one does nothing.
thread_local int held_by_thread = 0;

/// OpenBLAS allocates 140 kB per thread at the thread's first call (0.3.34), and if that fails, the C library ends the
/// process. Throws std::bad_alloc before that happens.
void find_memory_for_thread() {
  thread_local bool is_found = false;
  if (is_found) return;
  ::operator delete(::operator new(4 * 140'000));
  is_found = true;
}

Holders& holders() {
  static Holders of_process;
  return of_process;
}

}  // namespace

std::optional<int> blas_thread_setting() {
  if (!open_blas().has_threads()) return std::nullopt;
  return open_blas().get_num_threads();
}

void set_blas_thread_setting(int threads) {
  if (open_blas().has_threads()) open_blas().set_num_threads(threads);
}

BlasThreads::BlasThreads() : is_alone_(!serves_many()) {
  if (!open_blas().has_threads()) return;
  find_memory_for_thread();
  if (held_by_thread++ > 0) return;
  Holders& all = holders();
  if (is_alone_) {
    all.gate.lock();
  } else {
    all.gate.lock_shared();
  }
  const std::lock_guard<std::mutex> lock(all.counting);
  if (all.count++ > 0) return;
  all.before = open_blas().get_num_threads();
  if (all.before != 1) open_blas().set_num_threads(1);
}

BlasThreads::~BlasThreads() {
  if (!open_blas().has_threads() || --held_by_thread > 0) return;
  Holders& all = holders();
  {
    const std::lock_guard<std::mutex> lock(all.counting);
    const bool is_ours = --all.count == 0 && open_blas().get_num_threads() == 1;
    if (is_ours && all.before != 1) open_blas().set_num_threads(all.before);
  }
  if (is_alone_) {
    all.gate.unlock();
  } else {
    all.gate.unlock_shared();
  }
}

bool BlasThreads::serves_many() {
  // Only with threads of its own (1): with OpenMP (2), the number applies only to the thread that sets it; without
  // threads (0), two concurrent calls share their buffers.
  return open_blas().get_parallel == nullptr || open_blas().get_parallel() == 1;
}

std::string blas_library() {
  const std::string file = BlasFile().name();
  return open_blas().get_config == nullptr ? file : file + " (" + open_blas().get_config() + ")";
}

std::string blas_kernel() { return open_blas().get_corename == nullptr ? "" : open_blas().get_corename(); }

}  // namespace spectral_conformal

#else

namespace spectral_conformal {

std::optional<int> blas_thread_setting() { return std::nullopt; }
void set_blas_thread_setting(int) {}
BlasThreads::BlasThreads() : is_alone_(false) {}
BlasThreads::~BlasThreads() = default;
bool BlasThreads::serves_many() { return true; }
std::string blas_library() { return ""; }
std::string blas_kernel() { return ""; }

}  // namespace spectral_conformal

#endif
