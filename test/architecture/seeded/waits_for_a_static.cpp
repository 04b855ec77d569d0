// The gate must see the hidden lock of a static that is made on first use.
namespace landfix::test {

int made_at_run_time();

int waits_for_a_static() {
  static const int value = made_at_run_time();
  return value;
}

}  // namespace landfix::test
