# Every recipe stands alone on a fresh machine: set-up comes first and does nothing the second time.

.PHONY: help setup demo test check check-long readers report-check bench bench-check bench-planted fuzz deb
.DEFAULT_GOAL := help

help:
	@echo 'make demo        build, generate a furnished two-room scene and solve it'
	@echo 'make test        the tests'
	@echo 'make check       the whole gate: format, lints, tests, documentation, licences, a short fuzz'
	@echo 'make fuzz        FUZZ_SECONDS=15 of fuzzing a target'
	@echo 'make check-long  what takes too long for every change'
	@echo 'make readers     what solve writes, read by other projects (needs python3, node, npm and the network)'
	@echo 'make report-check  a report in headless Chromium, with screenshots (needs node, npm and the network)'
	@echo 'make bench-check  counts, instructions and time ratios against bench/baseline.json'
	@echo 'make bench-planted  plants a slow kernel and a changed count, and sees the check catch them'
	@echo 'make bench       Embree packet benchmarks (bench/)'
	@echo 'make deb         a Debian package, on Debian 13 with its Embree (needs cargo-deb)'
	@echo 'make setup       only bring what the build needs'

setup:
	@./setup.sh

demo: setup
	cargo build --release
	cargo run --release --quiet -- generate two-rooms --out demo
	cargo run --release --quiet -- solve demo/two-rooms.obj --out demo/solved

test: setup
	cargo test

check:
	@./setup.sh --check
	cargo fmt --check
	cargo clippy --all-targets --all-features -- --deny warnings
	cargo test
	RUSTDOCFLAGS='--deny warnings' cargo doc --no-deps
	cargo deny check licenses bans sources
	$(MAKE) fuzz

# Stable Rust has no sanitizers: `-s none`. `fuzz/seeds` holds what is worth keeping, and what once failed.
FUZZ_SECONDS = 15
FUZZ_TARGETS = loader extract occlusion visibility
fuzz:
	@./setup.sh --check
	for target in $(FUZZ_TARGETS); do \
		mkdir -p fuzz/corpus/$$target; \
		cargo fuzz run -s none $$target fuzz/corpus/$$target fuzz/seeds/$$target -- \
			-max_total_time=$(FUZZ_SECONDS) -timeout=20 -verbosity=0 || exit 1; \
	done

# Tests marked `ignored` take minutes each; properties are drawn from a seed of the day, and more often.
check-long: setup
	cargo test -- --ignored
	PROPTEST_RNG_SEED=$$(date +%Y%m%d) PROPTEST_CASES=2000 cargo test
	$(MAKE) readers
	$(MAKE) report-check
	$(MAKE) bench-planted
	$(MAKE) fuzz FUZZ_SECONDS=3600

# Other projects' readers are installed into target/ the first time.
readers: setup
	cargo build --release
	tests/readers/check.py target/release/certilux

# Headless Chromium is installed into target/ the first time; the screenshots are left there.
report-check: setup
	cargo build --release
	tests/report/check.sh target/release/certilux

bench: setup
	cargo bench --features c-baseline --bench embree_packets

# Manual pages and completions are made by the program that is packaged.
deb: setup
	cargo build --release --locked
	mkdir -p target/manual
	cargo run --release --locked --quiet -- --quiet --no-config man --out target/manual/man1
	for shell in bash:certilux.bash zsh:_certilux fish:certilux.fish; do \
		cargo run --release --locked --quiet -- completions $${shell%:*} >target/manual/$${shell#*:} || exit 1; \
	done
	cargo deb --no-build --locked

# The baseline is recorded anew, on a quiet machine and with valgrind installed, by whoever changes counts on purpose:
# target/release/certilux bench --suite ci --record bench/baseline.json
bench-check: setup
	cargo build --release
	target/release/certilux bench --suite ci --check bench/baseline.json

# Shows that the check catches what it is for: a kernel slower by 5 %, and one ray more.
bench-planted: setup
	bench/planted.sh
