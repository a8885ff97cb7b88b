//! Flattens `IN.obj` and compares the UVs, bit by bit, with those in `REFERENCE.obj`, if it is given.

use std::error::Error;
use std::str::FromStr;
use std::{env, fs};

use beltrami::{Flattener, Mesh};

/// The numbers of every line of `text` that begins with `word`, up to a slash each.
fn records<T: FromStr, const N: usize>(text: &str, word: &str) -> Vec<[T; N]> {
    let numbers = |line: &str| -> Option<[T; N]> {
        let mut parts = line.split_whitespace();
        let values = parts.by_ref().skip(1).map(|part| part.split('/').next()?.parse().ok());
        values.collect::<Option<Vec<T>>>()?.try_into().ok()
    };
    let matching = text.lines().filter(|line| line.split_whitespace().next() == Some(word));
    matching.map(|line| numbers(line).unwrap_or_else(|| panic!("cannot read {line}"))).collect()
}

fn bits(uvs: &[[f64; 2]]) -> Vec<[u64; 2]> {
    uvs.iter().map(|uv| uv.map(f64::to_bits)).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let paths: Vec<String> = env::args().skip(1).collect();
    let (input, reference) = match paths.as_slice() {
        [input] => (input, None),
        [input, reference] => (input, Some(reference)),
        _ => return Err("usage: consumer IN.obj [REFERENCE.obj]".into()),
    };
    let text = fs::read_to_string(input)?;
    let positions = records::<f64, 3>(&text, "v");
    let mut faces = records::<u32, 3>(&text, "f");
    faces.iter_mut().flatten().for_each(|vertex| *vertex -= 1);

    let mut flattener = Flattener::new()?;
    let map = flattener.flatten(&Mesh::new(&positions, &faces))?.ensure_injective()?;
    let uvs = map.uvs::<[f64; 2]>();
    if let Some(reference) = reference {
        let expected = records::<f64, 2>(&fs::read_to_string(reference)?, "vt");
        if bits(&uvs) != bits(&expected) {
            return Err("the UVs are not those of the reference".into());
        }
    }
    println!("{}: {} UVs", beltrami::build_info(), uvs.len());
    Ok(())
}
