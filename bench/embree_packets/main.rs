//! What an exchange's visibility costs with Embree: the baseline that every shortcut is held
//! against. Packets of 1, 8 and 16 rays, coherent and incoherent, asked one exchange at a time and
//! in batches over exchanges; and the wrapper against a bare C loop with the same rays and flags.
//!
//! Prints CSV: `isa,scene,triangles,rays,variant,minimum_ns,median_ns,blocked_share`, times in
//! nanoseconds of the thread's processor time an exchange of 8 rays (so that other programs on the
//! machine count only through shared caches). Variants run in turn, round after round; the minimum
//! over rounds of a millisecond or so is what a busy machine disturbs least. Then, as variant
//! `ratio-N`, the wrapper against C: ratio of the minima, and median of the ratios round by round.
//!
//! Variants: `rust-*` fill packets from a list of rays and ask (`single`: each exchange by itself;
//! `batch`: 256 exchanges filled, then asked; `half`: a packet of 16 with 8 lanes active);
//! `*-prepared` only copy finished packets and ask, in Rust and in C alike. Packets ask with
//! Embree's coherent flag, except where `incoherent` stands.
//!
//! `cargo bench --features c-baseline --bench embree_packets [-- ISA...]`, by default the
//! processor's best.

mod exchanges;
mod numbers;
mod rooms;

use certilux::embree::{
    CBaseline, CommittedScene, Device, DeviceConfig, Ray, RayPacket8, RayPacket16, SingleRay,
};
use exchanges::{Kind, RAYS, exchanges};
use rooms::Rooms;
use rustix::time::{ClockId, clock_gettime};
use std::hint::black_box;
use std::time::Instant;

/// Exchanges a round: their rays stay in the second-level cache, a round takes 1 to 2 ms.
const EXCHANGES: usize = 2048;
/// Exchanges that a batch fills before it asks.
const BATCH: usize = 256;
/// Rounds; the minimum no longer moves by more than 1 % beyond some 50.
const ROUNDS: usize = 100;

type Variant<'a> = (&'static str, Box<dyn Fn() -> u64 + 'a>);

/// Instruction sets by name; `best` is the processor's best.
const INSTRUCTION_SETS: [(&str, Option<&str>); 4] = [
    ("best", None),
    ("sse4.2", Some("sse4.2")),
    ("avx2", Some("avx2")),
    ("avx512", Some("avx512")),
];

fn main() {
    // Cargo adds `--bench`.
    let mut asked: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    if asked.is_empty() {
        asked.push("best".to_owned());
    }
    println!("isa,scene,triangles,rays,variant,minimum_ns,median_ns,blocked_share");
    for name in &asked {
        let (name, isa) = INSTRUCTION_SETS
            .into_iter()
            .find(|(known, _)| known == name)
            .expect("an instruction set: best, sse4.2, avx2 or avx512");
        let mut config = DeviceConfig::default();
        config.isa = isa;
        run(name, &config);
    }
}

fn run(isa: &str, config: &DeviceConfig) {
    let device = Device::new(config).expect("Embree opens");
    eprintln!("Embree {}, instruction set {isa}", device.version());
    // 2 k, 20 k, 100 k and 400 k triangles.
    for rooms_a_side in [2, 6, 14, 28] {
        let rooms = Rooms::new(rooms_a_side);
        let start = Instant::now();
        let scene = CommittedScene::build(&device, &rooms.positions, &rooms.triangles)
            .expect("the scene builds");
        eprintln!(
            "{} triangles built in {:.3} s",
            rooms.triangles.len(),
            start.elapsed().as_secs_f64()
        );
        for kind in Kind::ALL {
            let rays = exchanges(&rooms, kind, EXCHANGES);
            let label = format!(
                "{isa},rooms-{rooms_a_side}x{rooms_a_side},{},{}",
                rooms.triangles.len(),
                kind.name()
            );
            measure(&label, &scene, &rays);
        }
    }
}

fn measure(label: &str, scene: &CommittedScene, rays: &[Ray]) {
    let by_8: Vec<RayPacket8> = rays.chunks(8).map(fill8).collect();
    let by_16: Vec<RayPacket16> = rays.chunks(16).map(fill16).collect();
    let by_1: Vec<SingleRay> = rays.iter().map(|&ray| ray.into()).collect();
    let c = CBaseline(scene);
    let variants: Vec<Variant> = vec![
        ("rust-1-single", Box::new(|| singles(scene, rays))),
        ("rust-8-single", Box::new(|| single8(scene, rays))),
        ("rust-8-batch", Box::new(|| batch8(scene, rays))),
        ("rust-16-half", Box::new(|| half16(scene, rays))),
        ("rust-16-batch", Box::new(|| batch16(scene, rays))),
        ("rust-8-prepared", Box::new(|| prepared8(scene, &by_8))),
        ("c-8-prepared", Box::new(|| c.occluded8(&by_8, true))),
        ("rust-16-prepared", Box::new(|| prepared16(scene, &by_16))),
        ("c-16-prepared", Box::new(|| c.occluded16(&by_16, true))),
        (
            "rust-8-incoherent-prepared",
            Box::new(|| incoherent8(scene, &by_8)),
        ),
        (
            "c-8-incoherent-prepared",
            Box::new(|| c.occluded8(&by_8, false)),
        ),
        (
            "c-16-incoherent-prepared",
            Box::new(|| c.occluded16(&by_16, false)),
        ),
        ("c-1-prepared", Box::new(|| c.occluded1(&by_1, false))),
    ];
    let mut times = vec![Vec::with_capacity(ROUNDS); variants.len()];
    let mut blocked = vec![0; variants.len()];
    for round in 0..ROUNDS {
        for turn in 0..variants.len() {
            // Another one first each round, so that a disturbance does not always meet the same.
            let i = (turn + round) % variants.len();
            let start = processor_time();
            blocked[i] = black_box(variants[i].1());
            times[i].push((processor_time() - start) / EXCHANGES as f64);
        }
    }
    for ((name, _), (times, blocked)) in variants.iter().zip(times.iter().zip(&blocked)) {
        println!(
            "{label},{name},{:.1},{:.1},{:.4}",
            minimum(times),
            median(times),
            *blocked as f64 / rays.len() as f64
        );
    }
    for (name, rust, c) in [
        ("ratio-8", "rust-8-prepared", "c-8-prepared"),
        ("ratio-16", "rust-16-prepared", "c-16-prepared"),
        (
            "ratio-8-incoherent",
            "rust-8-incoherent-prepared",
            "c-8-incoherent-prepared",
        ),
    ] {
        let place = |name| {
            variants
                .iter()
                .position(|v| v.0 == name)
                .expect("listed above")
        };
        let (rust, c) = (place(rust), place(c));
        // Prepared packets are the same work in both languages: so must the answers be.
        assert_eq!(blocked[rust], blocked[c], "{name}");
        let ratios: Vec<f64> = times[rust]
            .iter()
            .zip(&times[c])
            .map(|(r, c)| r / c)
            .collect();
        println!(
            "{label},{name},{:.4},{:.4},",
            minimum(&times[rust]) / minimum(&times[c]),
            median(&ratios)
        );
    }
}

/// Nanoseconds that the thread has run.
fn processor_time() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 * 1e9 + time.tv_nsec as f64
}

fn minimum(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

fn fill8(rays: &[Ray]) -> RayPacket8 {
    let mut packet = RayPacket8::EMPTY;
    for (lane, ray) in rays.iter().enumerate() {
        packet.set(lane, ray.origin, ray.direction, ray.tnear, ray.tfar);
    }
    packet
}

fn fill16(rays: &[Ray]) -> RayPacket16 {
    let mut packet = RayPacket16::EMPTY;
    for (lane, ray) in rays.iter().enumerate() {
        packet.set(lane, ray.origin, ray.direction, ray.tnear, ray.tfar);
    }
    packet
}

fn singles(scene: &CommittedScene, rays: &[Ray]) -> u64 {
    rays.iter().map(|ray| u64::from(scene.occluded1(ray))).sum()
}

fn single8(scene: &CommittedScene, rays: &[Ray]) -> u64 {
    let mut packet = RayPacket8::EMPTY;
    rays.chunks_exact(RAYS)
        .map(|rays| {
            for (lane, ray) in rays.iter().enumerate() {
                packet.set(lane, ray.origin, ray.direction, ray.tnear, ray.tfar);
            }
            u64::from(scene.occluded8(&mut packet, RayPacket8::ALL).count_ones())
        })
        .sum()
}

fn batch8(scene: &CommittedScene, rays: &[Ray]) -> u64 {
    let mut packets = vec![RayPacket8::EMPTY; BATCH];
    let mut blocked = 0;
    for rays in rays.chunks(BATCH * 8) {
        let used = &mut packets[..rays.len() / 8];
        for (packet, rays) in used.iter_mut().zip(rays.chunks(8)) {
            for (lane, ray) in rays.iter().enumerate() {
                packet.set(lane, ray.origin, ray.direction, ray.tnear, ray.tfar);
            }
        }
        for packet in used {
            blocked += u64::from(scene.occluded8(packet, RayPacket8::ALL).count_ones());
        }
    }
    blocked
}

fn half16(scene: &CommittedScene, rays: &[Ray]) -> u64 {
    let mut packet = RayPacket16::EMPTY;
    rays.chunks_exact(RAYS)
        .map(|rays| {
            for (lane, ray) in rays.iter().enumerate() {
                packet.set(lane, ray.origin, ray.direction, ray.tnear, ray.tfar);
            }
            let active = RayPacket16::first(RAYS);
            u64::from(scene.occluded16(&mut packet, active).count_ones())
        })
        .sum()
}

fn batch16(scene: &CommittedScene, rays: &[Ray]) -> u64 {
    let mut packets = vec![RayPacket16::EMPTY; BATCH / 2];
    let mut blocked = 0;
    for rays in rays.chunks(BATCH * 8) {
        let used = &mut packets[..rays.len() / 16];
        for (packet, rays) in used.iter_mut().zip(rays.chunks(16)) {
            for (lane, ray) in rays.iter().enumerate() {
                packet.set(lane, ray.origin, ray.direction, ray.tnear, ray.tfar);
            }
        }
        for packet in used {
            blocked += u64::from(scene.occluded16(packet, RayPacket16::ALL).count_ones());
        }
    }
    blocked
}

fn prepared8(scene: &CommittedScene, packets: &[RayPacket8]) -> u64 {
    let ask = |packet: &RayPacket8| {
        let mut packet = *packet;
        u64::from(scene.occluded8(&mut packet, RayPacket8::ALL).count_ones())
    };
    packets.iter().map(ask).sum()
}

fn incoherent8(scene: &CommittedScene, packets: &[RayPacket8]) -> u64 {
    let ask = |packet: &RayPacket8| {
        let mut packet = *packet;
        u64::from(
            scene
                .occluded8_incoherent(&mut packet, RayPacket8::ALL)
                .count_ones(),
        )
    };
    packets.iter().map(ask).sum()
}

fn prepared16(scene: &CommittedScene, packets: &[RayPacket16]) -> u64 {
    let ask = |packet: &RayPacket16| {
        let mut packet = *packet;
        u64::from(scene.occluded16(&mut packet, RayPacket16::ALL).count_ones())
    };
    packets.iter().map(ask).sum()
}
