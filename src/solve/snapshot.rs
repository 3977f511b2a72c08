//! The state of a solve between two passes, as bytes: what the next pass reads, and nothing that can be
//! built again from the scene.
//!
//! That is the patches made so far, their irradiance, how it varies over them, and what they have yet to shoot, the statistics of the
//! passes and the scales of row normalisation. What stands above the patches, and how a patch's
//! light is spread over its children, is pulled anew, as at the end of every pass; the schedule of queries learns
//! within one pass and is not carried over.
//!
//! Layout, little endian: channels (u32), passes (u32) with their statistics and scales, power
//! that the last pass shot (f64 a channel), owners (u32), facets (u32); then each owner's count of facets and patches
//! (u32 each) and its arrays.

use super::facet_frame::FacetFrame;
use super::patch_split::PatchSplit;
use super::radiosity::{Gatherer, Light, Radiosity, Shooter, Slope};
use super::solution::PatchPath;
use super::statistics::PassStatistics;
use crate::cluster::Hierarchy;

/// What a solve carries from pass to pass beside its light.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Carried {
    /// One a completed pass.
    pub passes: Vec<PassStatistics>,
    /// The scale of each pass (1 without row normalisation).
    pub scales: Vec<f64>,
    /// Power of each channel that the last pass shot.
    pub shot: Vec<f64>,
}

/// A solve after some pass. Restored into a solver of the same scene and settings, the solve goes on to the
/// same bits as one that was never stopped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Snapshot {
    bytes: Vec<u8>,
}

/// Bytes that are no state of this solve.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the saved state does not belong to this solve: {0}")]
pub struct SnapshotError(pub String);

impl Snapshot {
    /// Saves the state between two passes: nothing is gathered that has not been pushed.
    pub fn take<const C: usize>(carried: &Carried, light: &Radiosity<C>) -> Self {
        let patches: usize = light.gatherers.iter().map(|g| g.children.len()).sum();
        let per_patch = bytes_of_a_patch::<C>();
        let mut out = Writer(Vec::with_capacity(
            patches * per_patch + light.gatherers.len() * 8 + carried.passes.len() * 128 + 64,
        ));
        out.u32(C as u32);
        out.u32(carried.passes.len() as u32);
        for (pass, scale) in carried.passes.iter().zip(&carried.scales) {
            out.pass(pass);
            out.f64(*scale);
        }
        carried.shot.iter().for_each(|&power| out.f64(power));
        out.u32(light.gatherers.len() as u32);
        out.u32(light.owner_of_facet.len() as u32);
        for (gatherer, shooter) in light.gatherers.iter().zip(&light.shooters) {
            out.u32(gatherer.facet_count);
            out.u32(gatherer.children.len() as u32);
            gatherer.children.iter().for_each(|&c| out.u32(c));
            gatherer.total.iter().flatten().for_each(|&e| out.f64(e));
            (gatherer.slopes.iter().flatten().flatten()).for_each(|e| out.bytes(&e.to_le_bytes()));
            (shooter.unshot.iter().flatten()).for_each(|b| out.bytes(&b.to_le_bytes()));
        }
        Self { bytes: out.0 }
    }

    /// Puts the state into the fresh light of the same scene; on any error the light stays as it is.
    ///
    /// # Errors
    /// The first thing that no solve of this scene can have saved.
    pub fn restore<const C: usize>(
        &self,
        hierarchy: &Hierarchy,
        frames: &[FacetFrame],
        light: &mut Radiosity<C>,
    ) -> Result<Carried, SnapshotError> {
        let mut input = Reader(&self.bytes);
        input.expect("channels", C)?;
        let carried = read_carried(&mut input, C)?;
        input.expect("receivers", light.gatherers.len())?;
        input.expect("facets", light.owner_of_facet.len())?;
        let mut owners = Vec::with_capacity(light.gatherers.len());
        for gatherer in &light.gatherers {
            input.expect("facets of a receiver", gatherer.facet_count as usize)?;
            owners.push(read_owner::<C>(&mut input, gatherer.facet_count as usize)?);
        }
        if !input.0.is_empty() {
            return Err(wrong(format!("{} bytes too many", input.0.len())));
        }
        for (owner, (gatherer, shooter)) in owners
            .into_iter()
            .zip(light.gatherers.iter_mut().zip(&mut light.shooters))
        {
            owner.move_into(gatherer, shooter);
        }
        light.pull_nodes(hierarchy, frames);
        Ok(carried)
    }

    /// The bytes, for a file.
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// From the bytes of a file; what they hold is judged by [`Self::restore`].
    pub fn from_bytes(bytes: Vec<u8>) -> Self {
        Self { bytes }
    }
}

fn wrong(what: impl Into<String>) -> SnapshotError {
    SnapshotError(what.into())
}

/// Bytes that a patch takes.
const fn bytes_of_a_patch<const C: usize>() -> usize {
    size_of::<u32>() + size_of::<Light<C>>() + size_of::<Slope<C>>() + size_of::<[f32; C]>()
}

/// One owner's arrays.
struct Owner<const C: usize> {
    children: Vec<u32>,
    total: Vec<Light<C>>,
    slopes: Vec<Slope<C>>,
    unshot: Vec<[f32; C]>,
}

impl<const C: usize> Owner<C> {
    fn move_into(self, gatherer: &mut Gatherer<C>, shooter: &mut Shooter<C>) {
        gatherer.gathered = vec![[[0.0; C]; 3]; self.children.len()];
        gatherer.total = self.total;
        gatherer.slopes = self.slopes;
        // Children stand behind their parents, so one walk from the back serves.
        let mut splits = vec![PatchSplit::default(); self.children.len()];
        for at in (0..self.children.len()).rev() {
            let first = self.children[at] as usize;
            if first != 0 {
                let parts = std::array::from_fn(|k| self.unshot[first + k]);
                let variance = std::array::from_fn(|k| splits[first + k].variance);
                splits[at] = PatchSplit::new(first as u32, parts, variance);
            }
        }
        shooter.splits = splits;
        shooter.unshot = self.unshot;
        gatherer.children = self.children;
    }
}

fn read_carried(input: &mut Reader, channels: usize) -> Result<Carried, SnapshotError> {
    let mut carried = Carried::default();
    for number in 1..=input.u32()? {
        let pass = input.pass()?;
        if pass.pass != number {
            return Err(wrong(format!("pass {number} is called {}", pass.pass)));
        }
        carried.passes.push(pass);
        carried.scales.push(input.finite()?);
    }
    for _ in 0..channels {
        carried.shot.push(input.finite()?);
    }
    Ok(carried)
}

fn read_owner<const C: usize>(
    input: &mut Reader,
    facets: usize,
) -> Result<Owner<C>, SnapshotError> {
    let patches = input.u32()? as usize;
    // Checked before anything is reserved: a number must not cost memory that no file fills.
    let per_patch = bytes_of_a_patch::<C>();
    if patches < facets || patches.saturating_mul(per_patch) > input.0.len() {
        return Err(wrong(format!("{patches} patches on {facets} facets")));
    }
    let children = (0..patches)
        .map(|_| input.u32())
        .collect::<Result<Vec<u32>, _>>()?;
    check_forest(&children, facets)?;
    let mut total = vec![[0.0; C]; patches];
    for value in total.iter_mut().flatten() {
        *value = input.finite()?;
    }
    let mut slopes = vec![[[0.0; C]; 3]; patches];
    for value in slopes.iter_mut().flatten().flatten() {
        *value = input.finite_f32()?;
    }
    let mut unshot = vec![[0.0; C]; patches];
    for value in unshot.iter_mut().flatten() {
        *value = input.finite_f32()?;
    }
    Ok(Owner {
        children,
        total,
        slopes,
        unshot,
    })
}

/// Every group of four behind the facets has one parent, which stands before it and is not too deep.
fn check_forest(children: &[u32], facets: usize) -> Result<(), SnapshotError> {
    let groups = (children.len() - facets) / 4;
    if facets + 4 * groups != children.len() {
        return Err(wrong("patches are not in fours"));
    }
    // Of each group; 0 while its parent has not been met.
    let mut levels = vec![0u32; groups];
    for (at, &first) in children.iter().enumerate() {
        let first = first as usize;
        if first == 0 {
            continue;
        }
        let level = at.checked_sub(facets).map_or(0, |k| levels[k / 4]);
        let group = first.checked_sub(facets).filter(|offset| offset % 4 == 0);
        match group.and_then(|offset| levels.get_mut(offset / 4)) {
            Some(below) if *below == 0 && first > at && level < PatchPath::MAX_LEVEL => {
                *below = level + 1;
            }
            _ => return Err(wrong("patches do not form a tree")),
        }
    }
    match levels.contains(&0) {
        false => Ok(()),
        true => Err(wrong("a patch has no parent")),
    }
}

/// Appends numbers.
struct Writer(Vec<u8>);

impl Writer {
    fn bytes(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }

    fn u32(&mut self, value: u32) {
        self.bytes(&value.to_le_bytes());
    }

    fn u64(&mut self, value: u64) {
        self.bytes(&value.to_le_bytes());
    }

    fn f64(&mut self, value: f64) {
        self.bytes(&value.to_le_bytes());
    }

    fn pass(&mut self, statistics: &PassStatistics) {
        // Named one by one, so that a new field cannot be forgotten.
        let &PassStatistics {
            pass,
            seconds,
            exchanges,
            exchanges_blocked,
            exchanges_sampled_clear,
            rays,
            rays_blocked,
            native_rays,
            native_rays_blocked,
            shafts,
            occluded_claims,
            visible_claims,
            exchanges_visible,
            unshot,
        } = statistics;
        self.u32(pass);
        self.f64(seconds);
        for count in [
            exchanges,
            exchanges_blocked,
            exchanges_sampled_clear,
            rays,
            rays_blocked,
            native_rays,
            native_rays_blocked,
            shafts,
            occluded_claims,
            visible_claims,
            exchanges_visible,
        ] {
            self.u64(count);
        }
        self.f64(unshot);
    }
}

/// Takes numbers off the front.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn array<const N: usize>(&mut self) -> Result<[u8; N], SnapshotError> {
        let (head, tail) =
            (self.0.split_first_chunk()).ok_or_else(|| wrong("it ends too early"))?;
        self.0 = tail;
        Ok(*head)
    }

    fn u32(&mut self) -> Result<u32, SnapshotError> {
        self.array().map(u32::from_le_bytes)
    }

    fn u64(&mut self) -> Result<u64, SnapshotError> {
        self.array().map(u64::from_le_bytes)
    }

    fn finite(&mut self) -> Result<f64, SnapshotError> {
        let value = self.array().map(f64::from_le_bytes)?;
        match value.is_finite() {
            true => Ok(value),
            false => Err(wrong("a number is not finite")),
        }
    }

    fn finite_f32(&mut self) -> Result<f32, SnapshotError> {
        let value = self.array().map(f32::from_le_bytes)?;
        match value.is_finite() {
            true => Ok(value),
            false => Err(wrong("a number is not finite")),
        }
    }

    fn expect(&mut self, what: &str, wanted: usize) -> Result<(), SnapshotError> {
        match self.u32()? as usize {
            found if found == wanted => Ok(()),
            found => Err(wrong(format!("{found} {what} instead of {wanted}"))),
        }
    }

    /// In the order of [`Writer::pass`].
    fn pass(&mut self) -> Result<PassStatistics, SnapshotError> {
        Ok(PassStatistics {
            pass: self.u32()?,
            seconds: self.finite()?,
            exchanges: self.u64()?,
            exchanges_blocked: self.u64()?,
            exchanges_sampled_clear: self.u64()?,
            rays: self.u64()?,
            rays_blocked: self.u64()?,
            native_rays: self.u64()?,
            native_rays_blocked: self.u64()?,
            shafts: self.u64()?,
            occluded_claims: self.u64()?,
            visible_claims: self.u64()?,
            exchanges_visible: self.u64()?,
            unshot: self.finite()?,
        })
    }
}
