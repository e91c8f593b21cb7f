//! Hashes of text, the same on every machine and in every run.

/// Names a text by its content. Two different texts have the same hash once in 2^128 by chance;
/// it is no defence against someone who looks for one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ContentHash([u64; 2]);

impl ContentHash {
    /// The hash of a text.
    pub fn of(text: &str) -> Self {
        Self::of_bytes(text.as_bytes())
    }

    /// The hash of bytes, which need not be text.
    pub fn of_bytes(bytes: &[u8]) -> Self {
        let mut lanes = [bytes.len() as u64 ^ SEEDS[0], SEEDS[1]];
        for word in words(bytes) {
            lanes[0] = mix(lanes[0] ^ word, SEEDS[1]);
            lanes[1] = mix(lanes[1].rotate_left(23) ^ word, SEEDS[2]);
        }
        Self(lanes)
    }

    /// The hash as bytes, for hashes of hashes.
    pub fn bytes(self) -> [u8; 16] {
        let mut bytes = [0; 16];
        bytes[..8].copy_from_slice(&self.0[0].to_le_bytes());
        bytes[8..].copy_from_slice(&self.0[1].to_le_bytes());
        bytes
    }
}

/// A hash of a name that does not tell upper from lower case in ASCII.
pub fn fold_hash(name: &str) -> u64 {
    let start = name.len() as u64 ^ SEEDS[0];
    words(name.as_bytes()).fold(start, |hash, word| mix(hash ^ fold_case(word), SEEDS[1]))
}

/// Odd numbers without structure: the fractional digits of the golden ratio, pi and e.
const SEEDS: [u64; 3] = [
    0x9e37_79b9_7f4a_7c15,
    0x243f_6a88_85a3_08d3,
    0xb7e1_5162_8aed_2a6b,
];

/// Both halves of the product: every bit of the operands reaches every bit of the result.
fn mix(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    (product as u64) ^ ((product >> 64) as u64)
}

/// Bit 5 is what tells `a` from `A`. Other signs fall together too, which a hash may do.
fn fold_case(word: u64) -> u64 {
    word & 0xdfdf_dfdf_dfdf_dfdf
}

/// The text in pieces of eight bytes, the last one filled with zeros.
fn words(bytes: &[u8]) -> impl Iterator<Item = u64> {
    bytes.chunks(8).map(|chunk| {
        let mut word = [0; 8];
        word[..chunk.len()].copy_from_slice(chunk);
        u64::from_le_bytes(word)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_of_one_byte_changes_the_hash() {
        let hash = ContentHash::of("x := 1; y := 2;");
        assert_ne!(hash, ContentHash::of("x := 1; y := 3;"));
        assert_ne!(hash, ContentHash::of("x := 1; y := 2; "));
        assert_ne!(hash, ContentHash::of("x := 1; y := 2;\0"));
        assert_eq!(hash, ContentHash::of("x := 1; y := 2;"));
    }

    #[test]
    fn case_does_not_change_the_hash_of_a_name() {
        assert_eq!(fold_hash("Motor_Speed1"), fold_hash("MOTOR_sPEED1"));
        assert_ne!(fold_hash("motor1"), fold_hash("motor2"));
    }
}
